//! `linearize`: the matrices of the linearised motion.

use super::contract::{Declared, Features, POSE, Pose};
use crate::model::decode::decoder::Decoder;
use crate::model::fault::At;
use crate::model::fields::{Shape, Size};
use crate::model::keys::{Words, keys, words};
use crate::model::merge::Node;
use crate::model::study::{Kind, Linearize};

words! {
    /// Files of the matrices.
    enum Write {
        /// That of the study, which always has them.
        Json = "json",
        /// A table for each matrix.
        Csv = "csv",
        /// One MAT-file.
        Mat = "mat",
    }
}

keys! {
    /// `linearize`.
    TABLE = LinearizeKeys "a linearize study" [] {
        at: may POSE, "The state: the start with its velocities, or the rest in an equilibrium.";
        inputs: may Shape::List(&Shape::Name("the name of a parameter"), Size::AtLeast(1)), "Parameters that are inputs.";
        write: may Shape::List(&Shape::Word(Write::WORDS), Size::AtLeast(1)), "Files beside the JSON, which always holds the matrices.";
    }
}

pub(super) const LINEARIZE: Declared =
    Declared::new("linearize", &TABLE, "Matrices of the linearised motion about a state.", |decoder, node, at| {
        Some((Kind::Linearize(linearize(decoder, node, at)?), Features::WHOLE))
    });

fn linearize<'n>(decoder: &mut Decoder<'n>, node: Node<'n>, at: &At<'_, 'n>) -> Option<Linearize> {
    let keys = LinearizeKeys::of(node);
    let section = at.key(keys.inputs);
    let mut inputs = Vec::new();
    for (i, name) in keys.inputs.items().iter().enumerate().filter_map(|(i, item)| Some((i, item.as_str()?))) {
        let place = section.index(i);
        let parameter = decoder.parameter_named(name, &place, false)?;
        if inputs.contains(&parameter) {
            let fault = decoder.fault("duplicate-name", &place, format!("`{name}` is an input already"), "each input once");
            fault.help = Some("remove one of the two".to_owned());
        }
        inputs.push(parameter);
    }
    let writes = |what: Write| keys.write.items().iter().any(|item| item.as_str().and_then(Write::named) == Some(what));
    let at_equilibrium = keys.at.word() == Some(Pose::Statics);
    Some(Linearize { at_equilibrium, inputs, csv: writes(Write::Csv), mat: writes(Write::Mat) })
}
