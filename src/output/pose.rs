//! What a drawing of a mechanism shows.

/// A mechanism in the plane, all lengths in metres, y upwards.
///
/// Everything that moves has one entry for each position; the first position is drawn strongly, the others paler and paler.
/// Points that are not finite are left out.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Above the picture; may be empty.
    pub title: String,
    /// The bodies; the frame is shown by its joints.
    pub bodies: Vec<Outline>,
    /// The joints.
    pub joints: Vec<Symbol>,
    /// Springs and dampers.
    pub links: Vec<Link>,
    /// The paths of points.
    pub traces: Vec<Trace>,
}

/// A body: a rounded bar through two points, a rounded plate around more, a disc for a single one that has no joint.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Beside the body; may be empty.
    pub name: String,
    /// For each position the points of the body: its joints, its attached points.
    pub poses: Vec<Vec<[f64; 2]>>,
}

/// A joint.
#[derive(Clone, Debug, Default)]
pub struct Symbol {
    /// Beside the joint; may be empty.
    pub name: String,
    /// What it looks like.
    pub kind: SymbolKind,
    /// One of its sides is the frame: hatched.
    pub grounded: bool,
    /// Where it is, for each position.
    pub poses: Vec<Placement>,
}

/// What a joint looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SymbolKind {
    /// A small circle.
    #[default]
    Hinge,
    /// A box on a way.
    Slide,
    /// A pin in a slot.
    Slot,
    /// Two circles, one in the other.
    Ball,
    /// A small square: rigid.
    Weld,
}

/// Where a joint is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Its point.
    pub at: [f64; 2],
    /// The direction of a slide or a slot, of any length; unused by others.
    pub along: [f64; 2],
    /// The ends of the way or slot, if they are known; else it is drawn a little longer than what is seen of the motion.
    pub way: Option<[[f64; 2]; 2]>,
}

/// A massless element between two points.
#[derive(Clone, Debug, Default)]
pub struct Link {
    /// Beside it; may be empty.
    pub name: String,
    /// What it looks like.
    pub kind: LinkKind,
    /// Its ends, for each position; only the first is drawn.
    pub poses: Vec<[[f64; 2]; 2]>,
}

/// What a massless element looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinkKind {
    /// A zigzag.
    #[default]
    Spring,
    /// A piston in a cylinder.
    Damper,
    /// A thin line.
    Rod,
}

/// The path of a point.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Beside the path; may be empty.
    pub name: String,
    /// Its points; one that is not finite breaks it.
    pub points: Vec<[f64; 2]>,
}
