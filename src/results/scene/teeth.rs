//! Outlines of teeth in the plane: involutes of 20° (ISO 53), one module high and one and a quarter deep.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Pressure angle, rad.
const PRESSURE: f64 = PI / 9.0;
/// Height of a tooth above its pitch line, modules.
const TIP: f64 = 1.0;
/// Depth of the gaps below it, modules.
const ROOT: f64 = 1.25;
/// What of a rack is below its gaps, modules.
const BACK: f64 = 1.75;
/// Points of a flank.
const FLANK: usize = 5;

/// Outline of a wheel about `center`, counter-clockwise, m: of `teeth` teeth on the pitch circle `radius`, m, the first one in the direction
/// `first`, rad. With a negative radius it is that of a wheel whose teeth are the gaps of a ring, which has a tooth in the direction `first`.
pub(crate) fn wheel(center: [f64; 2], radius: f64, teeth: usize, first: f64) -> Vec<[f64; 2]> {
    let (pitch, inner, count) = (radius.abs(), radius < 0.0, teeth as f64);
    let module = 2.0 * pitch / count;
    let [low, high] = if inner { [TIP, ROOT] } else { [ROOT, TIP] };
    let flank: [(f64, f64); FLANK] = std::array::from_fn(|k| {
        let r = pitch + module * ((low + high) * k as f64 / (FLANK - 1) as f64 - low);
        (r, half(count, pitch, r))
    });
    let on = |(r, angle): (f64, f64)| [center[0] + r * angle.cos(), center[1] + r * angle.sin()];
    let gap = if inner { 0.5 } else { 0.0 };
    (0..teeth)
        .flat_map(|k| {
            let middle = first + TAU * (k as f64 + gap) / count;
            flank.map(|(r, wide)| (r, middle - wide)).into_iter().chain(flank.map(|(r, wide)| (r, middle + wide)).into_iter().rev())
        })
        .map(on)
        .collect()
}

/// Radius of the rim around a wheel with inner teeth, m: of its pitch circle 8 %, or a module beyond the teeth.
pub(crate) fn rim(radius: f64, teeth: usize) -> f64 {
    radius.abs() * (1.0 + 2.0 * (ROOT + 1.0) / teeth as f64).max(1.08)
}

/// Half of the angle that a tooth of a wheel of `count` teeth takes at a radius, rad; below the base circle as on it.
///
/// On the pitch circle it is π/2z, and at r by inv α − inv α_r more, with inv α = tan α − α and r cos α_r = r_pitch cos α.
fn half(count: f64, pitch: f64, radius: f64) -> f64 {
    let involute = |angle: f64| angle.tan() - angle;
    let at = (pitch * PRESSURE.cos() / radius).min(1.0).acos();
    (FRAC_PI_2 / count + involute(PRESSURE) - involute(at)).max(0.0)
}

/// Outline of a rack of a module, m, whose pitch line goes through `from` along the unit vector `along`, with teeth on the side `up`, a unit
/// vector: from the place `ends[0]` along the line to `ends[1]`, m, with a tooth at `first`.
pub(crate) fn rack(module: f64, [from, along, up]: [[f64; 2]; 3], ends: [f64; 2], first: f64) -> Vec<[f64; 2]> {
    let pitch = PI * module;
    let at = |s: f64, height: f64| std::array::from_fn(|i| from[i] + s * along[i] + height * module * up[i]);
    let wide = |height: f64| 0.25 * pitch - height * module * PRESSURE.tan();
    let [low, high] = ends.map(|end| ((end - first) / pitch).round());
    let teeth = (0..=(high - low).max(0.0) as usize).flat_map(|k| {
        let middle = first + (low + k as f64) * pitch;
        [(-wide(-ROOT), -ROOT), (-wide(TIP), TIP), (wide(TIP), TIP), (wide(-ROOT), -ROOT)].map(|(s, height)| at(middle + s, height))
    });
    let [start, end] = [low - 0.5, high.max(low) + 0.5].map(|k| first + k * pitch);
    let back = [at(end, -ROOT), at(end, -ROOT - BACK), at(start, -ROOT - BACK), at(start, -ROOT)];
    teeth.chain(back).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tooth_is_as_wide_as_a_gap_on_the_pitch_circle() {
        let (radius, teeth) = (0.2, 20);
        assert!((half(20.0, radius, radius) - PI / 40.0).abs() < 1e-15);
        let outline = wheel([1.0, 2.0], radius, teeth, 0.3);
        let away: Vec<f64> = outline.iter().map(|[x, y]| (x - 1.0).hypot(y - 2.0)).collect();
        let [least, most] = [away.iter().copied().fold(1.0, f64::min), away.iter().copied().fold(0.0, f64::max)];
        // of module 20 mm
        assert!((most - 0.22).abs() < 1e-12 && (least - 0.175).abs() < 1e-12, "{least} {most}");
        // the first tooth stands in its direction
        let tips = [outline[FLANK - 1], outline[FLANK]];
        let middle = [0.5 * (tips[0][0] + tips[1][0]) - 1.0, 0.5 * (tips[0][1] + tips[1][1]) - 2.0];
        assert!((middle[1].atan2(middle[0]) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_ring_leaves_room_for_the_teeth_of_its_wheels() {
        // its teeth reach one module inwards, and one and a quarter outwards there is none
        let away = wheel([0.0; 2], -0.4, 40, 0.0).into_iter().map(|[x, y]| x.hypot(y)).collect::<Vec<_>>();
        let [least, most] = [away.iter().copied().fold(1.0, f64::min), away.iter().copied().fold(0.0, f64::max)];
        assert!((most - 0.425).abs() < 1e-12 && (least - 0.38).abs() < 1e-12, "{least} {most}");
    }

    #[test]
    fn a_rack_has_its_teeth_from_end_to_end() {
        let outline = rack(0.01, [[0.0; 2], [1.0, 0.0], [0.0, 1.0]], [-0.1, 0.2], 0.003);
        let teeth = outline.chunks_exact(4).count() - 1;
        let pitch = PI * 0.01;
        assert_eq!(teeth as f64, ((0.2 - 0.003) / pitch).round() - ((-0.1 - 0.003) / pitch).round() + 1.0);
        let top = outline.iter().map(|p| p[1]).fold(0.0, f64::max);
        let bottom = outline.iter().map(|p| p[1]).fold(0.0, f64::min);
        assert!((top - 0.01).abs() < 1e-12 && (bottom + 0.03).abs() < 1e-12, "{top} {bottom}");
        // on the pitch line teeth are as wide as gaps
        let [low, high] = [outline[0], outline[1]];
        let s = low[0] + (high[0] - low[0]) * -low[1] / (high[1] - low[1]);
        let middle = 0.5 * (outline[1][0] + outline[2][0]);
        assert!((middle - s - 0.25 * pitch).abs() < 1e-12);
    }
}
