//! The true shape of a body, as the model gives it: for drawings, no mechanics depends on it.

/// A shape in the frame of its body, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// A straight bar; thin if its width and height are 0.
    Bar {
        /// One end.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Width across, along y of a bar along x.
        width: f64,
        /// Height, along z of a bar along x; of others both are turned with it by the smallest rotation. 0 in the plane.
        height: f64,
    },
    /// A disc.
    Disc {
        /// Centre.
        center: [f64; 3],
        /// What it is round about, of length 1; z in the plane.
        axis: [f64; 3],
        /// Radius.
        radius: f64,
        /// Thickness; thin if 0.
        thickness: f64,
    },
    /// A plate (planar: two sizes) or box, centred at the origin.
    Block {
        /// Sizes along the axes of the body.
        size: [f64; 3],
    },
    /// A ball centred at the origin.
    Ball {
        /// Radius.
        radius: f64,
    },
}

/// A solid that a body is drawn as, in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// What it is.
    pub form: SolidForm,
    /// Its middle, m.
    pub at: [f64; 3],
    /// Its own axes, as the columns of a rotation.
    pub turned: [[f64; 3]; 3],
}

/// Solids with their sizes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidForm {
    /// A box.
    Box {
        /// Sizes along its own axes.
        size: [f64; 3],
    },
    /// A cylinder about its own z axis.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length.
        length: f64,
    },
    /// A ball.
    Ball {
        /// Radius.
        radius: f64,
    },
}

impl Solid {
    /// A point of its own frame in that of the body, m.
    #[must_use]
    pub fn point(&self, own: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.at[i] + (0..3).map(|k| self.turned[i][k] * own[k]).sum::<f64>())
    }

    /// The corners of the box along its own axes that is around it, in the frame of the body, m.
    #[must_use]
    pub fn corners(&self) -> [[f64; 3]; 8] {
        let half = match self.form {
            SolidForm::Box { size } => size.map(|x| 0.5 * x),
            SolidForm::Cylinder { radius, length } => [radius, radius, 0.5 * length],
            SolidForm::Ball { radius } => [radius; 3],
        };
        std::array::from_fn(|k| self.point(std::array::from_fn(|i| if k >> i & 1 == 0 { -half[i] } else { half[i] })))
    }

    /// Whether a point of the body lies in it or on it, m.
    #[must_use]
    pub fn holds(&self, point: [f64; 3]) -> bool {
        let from: [f64; 3] = std::array::from_fn(|i| point[i] - self.at[i]);
        let own: [f64; 3] = std::array::from_fn(|k| (0..3).map(|i| self.turned[i][k] * from[i]).sum());
        let within = |x: f64, most: f64| x.abs() <= most * (1.0 + 1e-6);
        match self.form {
            SolidForm::Box { size } => (0..3).all(|i| within(own[i], 0.5 * size[i])),
            SolidForm::Cylinder { radius, length } => within(own[0].hypot(own[1]), radius) && within(own[2], 0.5 * length),
            SolidForm::Ball { radius } => within(own[0].hypot(own[1]).hypot(own[2]), radius),
        }
    }
}
