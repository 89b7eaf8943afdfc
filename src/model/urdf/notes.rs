//! What a URDF says and the model does not use: nothing is dropped in silence.

/// Remarks by kind, in the order in which they were first made.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    list: Vec<Note>,
    /// Links that move and carry no mass.
    bare: Vec<Bare>,
}

/// A link that moves and carries no mass.
#[derive(Clone, Debug)]
struct Bare {
    /// Its name in the file.
    name: String,
    /// Its name and those of all that it carries, in the model.
    bodies: Vec<String>,
    /// Byte of the file.
    at: usize,
}

/// One kind of remark with all that it is about.
#[derive(Clone, Debug)]
struct Note {
    /// The sentence; `{}` stands for what it is about.
    sentence: String,
    about: Vec<String>,
    /// How many times it was made; more than `about` where things have no name.
    count: usize,
    /// Byte of the file where it was made first.
    at: usize,
}

/// Longest list of one remark.
const MOST_NAMED: usize = 40;

impl Notes {
    /// Elements or attributes that are passed over.
    pub(super) fn unused(&mut self, name: &str, at: usize) {
        let what = match name.split_once("/@") {
            Some((element, attribute)) => format!("attribute `{attribute}` of `<{element}>`"),
            None => format!("`<{name}>`"),
        };
        self.add(&format!("{what}, {{}}: not used"), None, at);
    }

    /// A remark about something with a name.
    pub(super) fn about(&mut self, sentence: &str, about: String, at: usize) {
        self.add(sentence, Some(about), at);
    }

    /// A link that moves and carries no mass; `bodies` are it and what it carries, by their names in the model.
    pub(super) fn without_mass(&mut self, name: String, bodies: Vec<String>, at: usize) {
        self.bare.push(Bare { name, bodies, at });
    }

    /// Bodies of the model that move and carry no mass.
    pub(super) fn bare(&self) -> Vec<String> {
        self.bare.iter().filter_map(|bare| bare.bodies.first().cloned()).collect()
    }

    fn add(&mut self, sentence: &str, about: Option<String>, at: usize) {
        let index = self.list.iter().position(|note| note.sentence == sentence).unwrap_or_else(|| {
            self.list.push(Note { sentence: sentence.to_owned(), about: Vec::new(), count: 0, at });
            self.list.len() - 1
        });
        self.list[index].count += 1;
        self.list[index].about.extend(about);
    }

    /// The remarks as sentences, with the line where each was made first. `heavy` tells whether the model itself gives a body mass.
    pub(crate) fn sentences(&self, text: &str, heavy: &dyn Fn(&str) -> bool) -> Vec<(usize, String)> {
        let line = |at: usize| text.as_bytes()[..at.min(text.len())].iter().filter(|c| **c == b'\n').count() + 1;
        let bare: Vec<&Bare> = self.bare.iter().filter(|bare| !bare.bodies.iter().any(|body| heavy(body))).collect();
        let last = bare.first().map(|first| Note {
            sentence:
                "links that move and carry no mass, without which a motion in time is not determined (give them `mass` and `inertia`): {}"
                    .to_owned(),
            about: bare.iter().map(|bare| bare.name.clone()).collect(),
            count: bare.len(),
            at: first.at,
        });
        self.list.iter().chain(&last).map(|note| (line(note.at), note.sentence.replacen("{}", &note.listed(), 1))).collect()
    }
}

impl Note {
    fn listed(&self) -> String {
        if self.about.is_empty() {
            return if self.count == 1 { "once".to_owned() } else { format!("{} times", self.count) };
        }
        let mut list = self.about.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
        if self.about.len() > MOST_NAMED {
            list.push_str(&format!(" and {} more", self.about.len() - MOST_NAMED));
        }
        list
    }
}
