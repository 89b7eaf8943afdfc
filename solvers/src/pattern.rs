//! Patterns of the blocks of a system, and the scales of its equations.

use crate::{Dims, Sparsity};

/// The velocities that share in a common translation, each with its components along up to three directions that are orthogonal unit
/// vectors (nv each); the velocities of two common translations differ.
pub type Common = Vec<(usize, [f64; 3])>;

/// What powers are functions of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// Nothing: they are zero, the energy stays as it is.
    Zero,
    /// t, q, v and z.
    State,
    /// The reactions, too, which take a solution of the accelerations.
    Reactions,
}

/// Patterns of all blocks of a system, and the scales of its equations; both taken once, at assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// M (nv × nv).
    pub mass: Sparsity,
    /// G (m × nv).
    pub g: Sparsity,
    /// K = ∂r/∂q (nv × nv).
    pub k: Sparsity,
    /// C = ∂r/∂v (nv × nv).
    pub c: Sparsity,
    /// ∂r/∂z (nv × nz).
    pub r_z: Sparsity,
    /// ∂r/∂λ beyond Gᵀ (nv × m); without entries no force depends on the reactions, and [`System::reaction_friction`](crate::System::reaction_friction) is not asked.
    pub r_lambda: Sparsity,
    /// ∂ż/∂q (nz × nv).
    pub z_q: Sparsity,
    /// ∂ż/∂v (nz × nv).
    pub z_v: Sparsity,
    /// ∂ż/∂z (nz × nz).
    pub z_z: Sparsity,
    /// D (nv), see [`kkt::metric`](crate::kkt::metric).
    pub metric: Vec<f64>,
    /// diag(G D⁻¹ Gᵀ) (m), see [`kkt::natural_row_scale`](crate::kkt::natural_row_scale), and
    /// [`kkt::row_scale`](crate::kkt::row_scale) where nothing is known of rows but their entries; E = 1e-8 of it.
    pub g_scale: Vec<f64>,
    /// The same where forces depend on the reactions, with one for rows that are components of one vector: 1e-6 of it is E there, see
    /// [`friction`](crate::friction).
    pub vector_scale: Vec<f64>,
    /// The smallest singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½ at the start that is not of redundant rows, see
    /// [`weakest`](crate::weakest::weakest).
    pub weakest: f64,
    /// Sizes of coordinates (nq): errors of q count in units of these, absolutely, since angles wind up and places drift.
    pub size_q: Vec<f64>,
    /// The same for displacements and velocities (nv): errors of v count relative to size + |v|, where |v| is what is left without
    /// the velocity in `common`.
    pub size_v: Vec<f64>,
    /// The same for states (nz): errors of z count relative to size + |z|.
    pub size_z: Vec<f64>,
    /// Translations of bodies that nothing holds in place: a constant velocity of all of them is no motion that errors are measured by.
    pub common: Vec<Common>,
    /// What the powers of [`System::power`](crate::System::power) are functions of.
    pub power: Power,
    /// Whether root functions read a and λ; else they are functions of t, q, v and z alone, which saves a solution at each look.
    pub roots_by_reactions: bool,
    /// Roots that are located even where switches are marched across (see [`Settings::locate`](crate::Settings::locate)): those of
    /// events, and of contacts whose crossing gives a blow.
    pub acting: Vec<usize>,
    /// Roots whose crossing can give a blow, and to what way each is known, in units of what it strikes along: blows that less than the time
    /// of this way lies between come at one instant.
    pub striking: Vec<(usize, f64)>,
    /// Roots of rates that do not become negative, as of a one-way clutch: those that a blow would make so take part in it.
    pub closing: Vec<usize>,
    /// Roots behind which forces follow other laws: a step that reaches far beyond one, or ends before it again, is made again.
    pub forceful: Vec<usize>,
    /// Roots that depend on time alone, in any modes: [`System::ahead`](crate::System::ahead) finds them.
    pub timed: Vec<usize>,
    /// Roots that are only read, as the switches of columns: crossing them is an [`Effect::Record`](crate::Effect::Record), and where they
    /// cannot be located the run goes on without them.
    pub observing: Vec<usize>,
    /// Roots that the crossing of others may let jump at one state, as those of `floor(mod(x, 1)/0.5)`; what they are made of stands before
    /// them.
    pub nested: Vec<usize>,
    /// Roots that need not be smooth functions of the state: they are looked at, not resolved.
    pub rough: Vec<usize>,
}

impl Pattern {
    /// Full blocks of the given sizes, with scales of one; no force depends on the reactions.
    pub fn dense(dims: Dims) -> Self {
        let (v, z, m) = (dims.v, dims.z, dims.rows());
        Self {
            mass: Sparsity::dense(v, v),
            g: Sparsity::dense(m, v),
            k: Sparsity::dense(v, v),
            c: Sparsity::dense(v, v),
            r_z: Sparsity::dense(v, z),
            r_lambda: Sparsity::empty(v, m),
            z_q: Sparsity::dense(z, v),
            z_v: Sparsity::dense(z, v),
            z_z: Sparsity::dense(z, z),
            metric: vec![1.0; v],
            g_scale: vec![1.0; m],
            vector_scale: vec![1.0; m],
            weakest: 1.0,
            size_q: vec![1.0; dims.q],
            size_v: vec![1.0; v],
            size_z: vec![1.0; z],
            common: Vec::new(),
            power: Power::Reactions,
            roots_by_reactions: false,
            acting: Vec::new(),
            striking: Vec::new(),
            closing: Vec::new(),
            forceful: Vec::new(),
            timed: Vec::new(),
            observing: Vec::new(),
            nested: Vec::new(),
            rough: Vec::new(),
        }
    }
}
