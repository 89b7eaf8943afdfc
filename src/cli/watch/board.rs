//! The board: what the threads of a watch share.

use super::super::Common;
use super::entry::{Computed, Entry, entry, shown, unknown};
use super::look::Look;
use super::request::Known;
use super::values::Values;
use grashof::model::{Document, Report};
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Studies that pages had in view lately, which are computed first.
const VIEWED: usize = 6;

/// What the threads of a watch share.
pub(super) struct Board {
    model: String,
    pub(super) common: Common,
    state: Mutex<State>,
    changed: Condvar,
    /// Number of what is to be computed: of the file with the values that were moved.
    wanted: AtomicU64,
    /// Whether what is computed has to make way for another study.
    gives_way: AtomicBool,
}

/// What is on it.
pub(super) struct State {
    /// Number of the last change.
    version: u64,
    /// The file as it was last sound.
    pub(super) document: Option<Arc<Document>>,
    /// Bytes of the file as it is now.
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) values: Values,
    /// What the page has of the model, and its number.
    head: (u64, Arc<Value>),
    /// What is wrong with the file as it is now.
    broken: Vec<Value>,
    /// Findings in the file that was last sound.
    findings: Vec<Value>,
    /// Why there is no file.
    away: Option<String>,
    studies: Vec<Entry>,
    viewed: VecDeque<String>,
}

impl Board {
    /// An empty one; `first` is the study to be shown first.
    pub(super) fn new(model: &str, common: &Common, first: Option<String>) -> Self {
        let set = common.set.iter().filter_map(|text| Some(text.split_once('=')?.0.trim().to_string())).collect();
        let state = State {
            version: 1,
            document: None,
            bytes: Arc::default(),
            values: Values::new(set),
            head: (0, Arc::default()),
            broken: Vec::new(),
            findings: Vec::new(),
            away: None,
            studies: Vec::new(),
            viewed: first.into_iter().collect(),
        };
        Self {
            model: model.into(),
            common: common.clone(),
            state: Mutex::new(state),
            changed: Condvar::new(),
            wanted: AtomicU64::new(1),
            gives_way: AtomicBool::new(false),
        }
    }

    /// The path of the model file.
    pub(super) fn model(&self) -> &str {
        &self.model
    }

    /// What is on it, for one thread at a time.
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes what is on it, and tells all who wait.
    fn change<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        let mut state = self.lock();
        state.version += 1;
        let done = change(&mut state);
        drop(state);
        self.changed.notify_all();
        done
    }

    /// Takes what was read of the file.
    pub(super) fn read(&self, look: Look) {
        // places lead into the text behind a sign of the byte order; the rest of the head follows once the study in view is computed
        let text = String::from_utf8_lossy(&look.bytes);
        let source = text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned();
        let literals = look.read.as_ref().map(|document| document.literals()).unwrap_or_default();
        self.change(|state| {
            (state.bytes, state.away) = (look.bytes, None);
            let mut head = if state.head.1.is_null() { unknown(&self.model) } else { (*state.head.1).clone() };
            head["model"]["source"] = source.into();
            state.head = (state.version, Arc::new(head));
            let document = match look.read {
                Ok(document) => document,
                Err(report) => return state.broken = shown(&report),
            };
            state.broken.clear();
            state.values.renew(literals);
            let mut known = std::mem::take(&mut state.studies);
            state.studies = document.study_names().into_iter().map(|name| entry(name, &mut known)).collect();
            state.document = Some(document);
            self.wanted.fetch_add(1, Ordering::SeqCst);
        });
    }

    /// Takes what there is to know of the model of number `of`, but for its text.
    pub(super) fn put_head(&self, of: u64, mut head: Value) {
        let source = self.lock().head.1["model"]["source"].clone();
        head["model"]["source"] = source;
        if self.wanted.load(Ordering::SeqCst) == of && *self.lock().head.1 != head {
            self.change(|state| state.head = (state.version, Arc::new(head)));
        }
    }

    /// The file cannot be read.
    pub(super) fn miss(&self, why: String) {
        self.change(|state| state.away = Some(why));
    }

    /// Moves values; what `change` says of them is given back, and studies are computed again if it is true.
    pub(super) fn move_values(&self, change: impl FnOnce(&mut Values) -> bool) -> bool {
        self.change(|state| {
            let moved = change(&mut state.values);
            if moved {
                self.wanted.fetch_add(1, Ordering::SeqCst);
            }
            moved
        })
    }

    /// A page has a study in view, which is computed before all others.
    pub(super) fn view(&self, name: &str) -> bool {
        let mut state = self.lock();
        let Some(entry) = state.studies.iter().find(|entry| entry.name == name) else { return false };
        let waits = entry.of != self.wanted.load(Ordering::SeqCst) && !entry.busy;
        state.viewed.retain(|viewed| viewed != name);
        state.viewed.push_front(name.into());
        state.viewed.truncate(VIEWED);
        if waits && state.studies.iter().any(|entry| entry.busy) {
            self.gives_way.store(true, Ordering::SeqCst);
        }
        true
    }

    /// Whether the file has a study.
    pub(super) fn has_study(&self, name: &str) -> bool {
        let state = self.lock();
        state.document.is_none() || state.studies.iter().any(|entry| entry.name == name)
    }

    /// Waits until something is to be computed: its number, and the file with the values that were moved.
    pub(super) fn wait_for_work(&self) -> (u64, Result<Arc<Document>, Report>) {
        let mut state = self.lock();
        loop {
            let wanted = self.wanted.load(Ordering::SeqCst);
            if let Some(document) = state.document.as_ref().filter(|_| state.studies.iter().any(|entry| entry.of != wanted)) {
                let moved = state.values.are_moved();
                return (wanted, if moved { state.values.apply(&self.model, document.text()).read } else { Ok(Arc::clone(document)) });
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether what is computed of number `of` is out of date, or makes way for another study.
    pub(super) fn is_stale(&self, of: u64) -> bool {
        self.wanted.load(Ordering::Relaxed) != of || self.gives_way.load(Ordering::Relaxed)
    }

    /// The study to be computed next of number `of`; none if there is no more or all is out of date.
    pub(super) fn next(&self, of: u64) -> Option<String> {
        if self.wanted.load(Ordering::SeqCst) != of {
            return None;
        }
        self.change(|state| {
            self.gives_way.store(false, Ordering::SeqCst);
            let waits = |entry: &Entry| entry.of != of;
            let viewed = state.viewed.iter().filter_map(|name| state.studies.iter().position(|entry| entry.name == *name));
            let found = viewed.chain(0..state.studies.len()).find(|&i| waits(&state.studies[i]))?;
            state.studies[found].busy = true;
            Some(state.studies[found].name.clone())
        })
    }

    /// Takes what came of a study of number `of`; none if it was given up on its way.
    pub(super) fn put(&self, of: u64, name: &str, computed: Option<Computed>) {
        let stale = self.wanted.load(Ordering::SeqCst) != of;
        self.change(|state| {
            let version = state.version;
            let Some(entry) = state.studies.iter_mut().find(|entry| entry.name == name) else { return };
            entry.busy = false;
            let Some(computed) = computed.filter(|_| !stale) else { return };
            entry.of = of;
            entry.bad = computed.bad || computed.json.is_none();
            entry.findings = shown(&computed.report);
            if let Some(json) = computed.json {
                (entry.about, entry.result) = (computed.about, (version, Arc::new(json)));
            }
        });
    }

    /// Takes what there is to say of the whole file of number `of`.
    pub(super) fn put_findings(&self, of: u64, report: &Report) {
        let findings = shown(report);
        if self.wanted.load(Ordering::SeqCst) == of && self.lock().findings != findings {
            self.change(|state| state.findings = findings);
        }
    }

    /// What a page has of a study, and its number.
    pub(super) fn result(&self, name: &str) -> Option<(u64, Arc<String>)> {
        self.lock().studies.iter().find(|entry| entry.name == name && entry.result.0 > 0).map(|entry| entry.result.clone())
    }

    /// What a page has of the model.
    pub(super) fn head(&self) -> Arc<Value> {
        Arc::clone(&self.lock().head.1)
    }

    /// What is on the board once it is newer than what a page knows, or when the time is over.
    pub(super) fn newer(&self, known: &Known, patience: Duration) -> String {
        let until = Instant::now() + patience;
        let mut state = self.lock();
        while state.version <= known.after {
            let Some(left) = until.checked_duration_since(Instant::now()).filter(|left| !left.is_zero()) else { break };
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        let mut json = state.json(self.wanted.load(Ordering::SeqCst)).to_string();
        let (head, result) = state.more(known);
        drop(state);
        insert(&mut json, "head", head.map(|head| head.to_string()).as_deref());
        insert(&mut json, "result", result.as_deref().map(String::as_str));
        json
    }
}

/// Adds a member to an object of JSON that has others.
fn insert(object: &mut String, name: &str, value: Option<&str>) {
    if let Some(value) = value {
        object.pop();
        object.push_str(&format!(",\"{name}\":{value}}}"));
    }
}

impl State {
    /// What goes with an answer to a page that knows less: what there is to know of the model, and the study in view.
    fn more(&self, known: &Known) -> (Option<Arc<Value>>, Option<Arc<String>>) {
        let head = known.model.filter(|number| *number != self.head.0).map(|_| Arc::clone(&self.head.1));
        let result = known.study.as_ref().and_then(|(name, has)| {
            let entry = self.studies.iter().find(|entry| entry.name == *name)?;
            (entry.result.0 > 0 && entry.result.0 != *has).then(|| Arc::clone(&entry.result.1))
        });
        (head, result)
    }

    fn json(&self, wanted: u64) -> Value {
        let studies: Vec<Value> = self.studies.iter().map(|entry| entry.json(wanted)).collect();
        json!({
            "version": self.version, "model": self.head.0, "away": self.away, "broken": self.broken, "findings": self.findings,
            "first": self.viewed.front(), "moved": self.values.are_moved(), "values": self.values.json(), "studies": studies,
        })
    }
}
