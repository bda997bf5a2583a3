//! Rods that make a rigid body of a group of masses.

use souple_math::Vec3;

/// Masses nearer to a line or a plane through others than this share of how far they are apart are in it.
const APART: f64 = 1e-4;

/// As many rods as hold masses that rest at places: `3 n − 6`, between four that are far from each other, and from each other one to three of these
/// that it is farthest from the plane of. `None` where all are in a plane, or in a line of more than two: rods do not hold what leaves that.
pub fn rods(places: &[Vec3]) -> Option<Vec<[u32; 2]>> {
    let count = places.len() as u32;
    if count < 3 {
        return Some((1..count).map(|other| [0, other]).collect());
    }
    let centre = places.iter().copied().sum::<Vec3>() / places.len() as f64;
    let farthest = |from: &dyn Fn(Vec3) -> f64| {
        let of = |mass: &u32| from(places[*mass as usize]);
        (0..count).fold(0, |best, mass| if of(&mass) > of(&best) { mass } else { best })
    };
    let at = |mass: u32| places[mass as usize];
    let a = farthest(&|place| (place - centre).length());
    let b = farthest(&|place| (place - at(a)).length());
    let size = (at(b) - at(a)).length();
    let c = farthest(&|place| (place - at(a)).cross(at(b) - at(a)).length());
    let across = (at(b) - at(a)).cross(at(c) - at(a));
    if across.length() <= APART * size * size {
        return None;
    }
    if count == 3 {
        return Some(vec![[0, 1], [0, 2], [1, 2]]);
    }
    let d = farthest(&|place| across.dot(place - at(a)).abs());
    if across.dot(at(d) - at(a)).abs() <= APART * size * across.length() {
        return None;
    }
    let base = [a, b, c, d];
    let mut rods: Vec<[u32; 2]> = Vec::with_capacity(3 * places.len() - 6);
    for (place, one) in base.into_iter().enumerate() {
        rods.extend(base[place + 1..].iter().map(|other| [one, *other]));
    }
    for mass in (0..count).filter(|mass| !base.contains(mass)) {
        // without each of the four in turn, the volume that the mass spans with the others
        let volume = |left: usize| {
            let [p, q, r] = [1, 2, 3].map(|step| at(base[(left + step) % 4]) - at(mass));
            p.cross(q).dot(r).abs()
        };
        let left = (0..4).fold(0, |best, left| if volume(left) > volume(best) { left } else { best });
        rods.extend((0..4).filter(|place| *place != left).map(|place| [base[place], mass]));
    }
    Some(rods)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths of the rods have as many independent gradients as a rigid body of the masses has not: `3 n − 6`.
    #[test]
    fn rods_hold_all_but_rigid_motions() {
        let mut places: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new((i & 1) as f64, 2.0 * (i >> 1 & 1) as f64, 3.0 * (i >> 2) as f64))
            .collect();
        places.push(Vec3::new(0.3, 0.5, 0.9));
        let rods = rods(&places).unwrap();
        assert_eq!(rods.len(), 3 * 9 - 6);
        let mut rows: Vec<Vec<f64>> = rods
            .iter()
            .map(|[a, b]| {
                let along = (places[*b as usize] - places[*a as usize]).try_normalised().unwrap();
                let mut row = vec![0.0; 27];
                for axis in 0..3 {
                    row[3 * *a as usize + axis] = -along[axis];
                    row[3 * *b as usize + axis] = along[axis];
                }
                row
            })
            .collect();
        // what is left of each row across those before it
        let mut least = f64::INFINITY;
        for at in 0..rows.len() {
            let (before, own) = rows.split_at_mut(at);
            let own = &mut own[0];
            for _ in 0..2 {
                for row in before.iter() {
                    let along: f64 = row.iter().zip(own.iter()).map(|(x, y)| x * y).sum();
                    own.iter_mut().zip(row).for_each(|(y, x)| *y -= along * x);
                }
            }
            let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
            least = least.min(length);
            own.iter_mut().for_each(|x| *x /= length);
        }
        assert!(least > 0.05, "{least}");
    }

    #[test]
    fn a_plane_and_a_line_are_not_held() {
        let flat: Vec<Vec3> = (0..4).map(|i| Vec3::new((i & 1) as f64, (i >> 1) as f64, 0.5)).collect();
        assert_eq!(rods(&flat), None);
        let line: Vec<Vec3> = (0..3).map(|i| Vec3::X * f64::from(i)).collect();
        assert_eq!(rods(&line), None);
        assert_eq!(rods(&flat[..3]), Some(vec![[0, 1], [0, 2], [1, 2]]));
        assert_eq!(rods(&flat[..2]), Some(vec![[0, 1]]));
        assert_eq!(rods(&flat[..1]), Some(vec![]));
    }
}
