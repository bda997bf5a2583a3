//! Tests of forces along chains: columns of masses of 1 kg that stand on each other, in a step in which they would fall by a unit.

use souple_math::{Mat3, Vec3};

use super::ContactSystem;
use super::gauss_seidel::Sweep;
use super::places::{Law, Place};
use super::{MOST_SWEEPS, SWEEPS_BEFORE};

/// What is between a mass and what it stands on.
#[derive(Clone, Copy)]
struct Joint {
    /// Masses by their numbers, or what does not move.
    above: Option<usize>,
    below: Option<usize>,
    law: Law,
    off: Vec3,
}

impl Joint {
    /// What a unit of force in another moves this by: masses that are on the same side of both, less those that are not.
    fn moved_by(&self, other: &Self) -> f64 {
        let same =
            |one: Option<usize>, other: Option<usize>| f64::from(u8::from(one.is_some() && one == other));
        same(self.above, other.above) + same(self.below, other.below)
            - same(self.above, other.below)
            - same(self.below, other.above)
    }
}

/// Joints of a column, from the floor up, under weights of 1 N.
fn column(count: usize, law: Law) -> Vec<Joint> {
    let off = |mass: usize| if mass == 0 { -Vec3::X } else { Vec3::ZERO };
    let joint = |mass: usize| Joint { above: Some(mass), below: mass.checked_sub(1), law, off: off(mass) };
    (0..count).map(joint).collect()
}

/// The problem of a step in which a force of 1 N moves a mass by a unit.
fn system(joints: &[Joint]) -> ContactSystem {
    let mut system =
        ContactSystem { scale: 1.0, tightness: 1.0, starts: vec![0], ..ContactSystem::default() };
    for (row, joint) in joints.iter().enumerate() {
        for (column, other) in joints.iter().enumerate() {
            let moved = joint.moved_by(other);
            if moved == 0.0 {
                continue;
            }
            if row == column {
                system.own.push(system.columns.len());
                system.stiffest.push([moved; 2]);
            }
            system.columns.push(column as u32);
            system.blocks.push(Mat3::IDENTITY * moved);
        }
        system.starts.push(system.columns.len());
        system.places.push(Place { force: Vec3::ZERO, law: joint.law, slope: 1.0, near: 0.0 });
        system.off.push(joint.off);
    }
    system.change = vec![Vec3::ZERO; joints.len()];
    (system.swept, system.direction) = (system.change.clone(), system.change.clone());
    system
}

/// Forces by rounds of sweeps and searches on faces, from where each round before left them, and what that took.
fn by_rounds(joints: &[Joint]) -> (Vec<Vec3>, u64) {
    let mut system = system(joints);
    for _ in 0..100 {
        system.solve(false);
        let found: Vec<Vec3> = system.change.clone();
        for (place, change) in found.iter().enumerate() {
            let moved = system.moved(place, &found);
            system.off[place] += moved;
            system.places[place].force += *change;
        }
        system.change.fill(Vec3::ZERO);
        if system.sweep() == Sweep::Settled {
            return (
                system.places.iter().map(|place| place.force).collect(),
                system.report.contact_iterations,
            );
        }
    }
    panic!("forces are not found");
}

/// Forces by sweeps alone.
fn by_sweeps(joints: &[Joint]) -> (Vec<Vec3>, u64) {
    let mut system = system(joints);
    assert!(system.sweep_on(1_000_000) == Sweep::Settled);
    (system.change.clone(), system.report.contact_iterations)
}

/// What a place may be off, a fifth of 1e-7: a sweep that changes none by more moves none by more than half of that after it was looked at.
const OFF: f64 = 2e-8;

/// The most that a force in a column of `n` changes for that: the floor bears the sum of what all above are off by, `n(n+1)/2`.
fn uncertainty(count: usize) -> f64 {
    OFF * 0.5 * (count * (count + 1)) as f64
}

/// Forces of both are the same to what either may be off.
fn assert_same(one: &[Vec3], other: &[Vec3]) {
    let most = 2.0 * uncertainty(one.len());
    for (joint, (a, b)) in one.iter().zip(other).enumerate() {
        assert!((*a - *b).length() < most, "joint {joint}: {a:?} and {b:?}");
    }
}

/// A column bears its weight: each joint what is above it. With all joints closed conjugate residuals end after as many products as there are masses,
/// where sweeps hand on what a joint bears by one joint each.
#[test]
fn columns_bear_their_weight() {
    let count = 80;
    let joints = column(count, Law::Cone(0.5));
    let (forces, rounds) = by_rounds(&joints);
    let weights: Vec<Vec3> = (0..count).map(|joint| Vec3::X * (count - joint) as f64).collect();
    assert_same(&forces, &weights);
    let (swept, sweeps) = by_sweeps(&joints);
    assert_same(&swept, &weights);
    // the first product is of the residual, and the sweeps that judge are a few
    let most = SWEEPS_BEFORE + count as u64 + 10;
    assert!(rounds <= most && sweeps > 2 * most, "{rounds}, by sweeps alone {sweeps}");
}

/// The mass on top is drawn aside by more than its friction bears: it slides, and what it rubs with is borne down to the floor.
#[test]
fn what_slides_is_borne_below() {
    let count = 60;
    let mut joints = column(count, Law::Cone(0.5));
    joints[count - 1].off.y = 5.0;
    let (forces, rounds) = by_rounds(&joints);
    let expected: Vec<Vec3> = (0..count).map(|joint| Vec3::new((count - joint) as f64, -0.5, 0.0)).collect();
    assert_same(&forces, &expected);
    let (swept, sweeps) = by_sweeps(&joints);
    assert_same(&swept, &expected);
    assert!(2 * rounds < sweeps, "{rounds}, by sweeps alone {sweeps}");
}

/// Where masses touch at two places of which one is a little higher, that one bears: forces go from the other to it as far as it is released. By sweeps they go
/// there by what the two contradict each other by, over and over, and are not there when a step has no sweeps left.
#[test]
fn the_higher_of_two_places_bears() {
    let count = 20;
    let joints = doubled(count, 1e-6);
    let (forces, rounds) = by_rounds(&joints);
    // as of columns alone, of whose two places either may be off
    let most = 2.0 * uncertainty(count);
    for (joint, pair) in forces.chunks(2).enumerate() {
        let weight = (count - joint) as f64;
        assert!(pair[0].x == 0.0 && (pair[1].x - weight).abs() < most, "{joint}: {pair:?}");
    }
    assert!(system(&joints).sweep_on(MOST_SWEEPS) == Sweep::Moved);
    assert!(rounds < MOST_SWEEPS, "{rounds}");
}

/// What yields at less than the weight above gives way, as by sweeps alone.
#[test]
fn limits_are_met_as_by_sweeps() {
    let joints = column(60, Law::Bounds(45.0));
    let (forces, rounds) = by_rounds(&joints);
    let (swept, sweeps) = by_sweeps(&joints);
    assert_same(&forces, &swept);
    assert!(forces.iter().all(|force| force.x.abs() <= 45.0));
    assert!(forces[0].x == 45.0 && forces[59].x < 45.0, "{forces:?}");
    assert!(rounds < sweeps, "{rounds}, by sweeps alone {sweeps}");
}

/// Joints of something else beside so many masses.
fn beside(masses: usize, joints: &[Joint]) -> impl Iterator<Item = Joint> {
    let of = move |mass: Option<usize>| mass.map(|mass| mass + masses);
    joints.iter().map(move |joint| Joint { above: of(joint.above), below: of(joint.below), ..*joint })
}

/// A column whose masses touch at two places, of which one is higher by so much.
fn doubled(count: usize, apart: f64) -> Vec<Joint> {
    let both = |joint: Joint| [Joint { off: joint.off + Vec3::X * apart, ..joint }, joint];
    column(count, Law::Cone(0.0)).into_iter().flat_map(both).collect()
}

/// What two places contradict each other by is no matter of a column beside them: it is found as if they agreed, in as many sweeps and products and as many
/// more as take forces away from the lower of each two.
#[test]
fn contradictions_leave_others_be() {
    let (count, long) = (20, 80);
    let agreed = by_both(count, long, 0.0);
    for apart in [1e-9, 1e-7, 1e-6] {
        assert!(by_both(count, long, apart) < 3 * agreed, "{apart}");
    }
}

/// Sweeps and products of a doubled column beside a plain one, whose forces are its weight.
fn by_both(count: usize, long: usize, apart: f64) -> u64 {
    let mut joints = doubled(count, apart);
    joints.extend(beside(count, &column(long, Law::Cone(0.0))));
    let (forces, rounds) = by_rounds(&joints);
    for (joint, force) in forces[2 * count..].iter().enumerate() {
        let weight = (long - joint) as f64;
        assert!((force.x - weight).abs() < 2.0 * uncertainty(long), "{apart}, {joint}: {force:?}");
    }
    rounds
}

/// Masses between a floor and a ceiling that is a little too low: no forces open all gaps, and none has to. They bear their weight as a column beside them does, whose
/// search on a face must not be led along what the others contradict each other by, nor they along what two places of a third do.
#[test]
fn what_is_squeezed_bears_its_weight() {
    let (squeezed, plain, twice) = (12, 80, 10);
    // so little that each joint of the column is asked for less than it may be off
    for (too_near, friction) in [(5e-8, 0.0), (1e-7, 0.0), (1e-7, 0.4)] {
        let law = Law::Cone(friction);
        let mut joints = column(squeezed, law);
        joints.push(Joint { above: None, below: Some(squeezed - 1), law, off: Vec3::X * (1.0 - too_near) });
        joints.extend(beside(squeezed, &column(plain, law)));
        joints.extend(beside(squeezed + plain, &doubled(twice, 2e-9)));
        let (forces, rounds) = by_rounds(&joints);
        // each product and each sweep may press by what the walls are too near
        let most = rounds as f64 * too_near + 2.0 * uncertainty(plain);
        let (row, others) = forces.split_at(squeezed + 1);
        let (column, pairs) = others.split_at(plain);
        // floor and ceiling may press against each other, by no more than weights had them do on the way
        let pressed = row[squeezed].x;
        assert!((0.0..squeezed as f64).contains(&pressed), "{pressed}");
        let expected = (0..=squeezed).map(|joint| pressed + (squeezed - joint) as f64);
        let expected = expected.chain((0..plain).map(|joint| (plain - joint) as f64));
        let expected = expected.chain((0..twice).map(|joint| (twice - joint) as f64));
        let found = row.iter().chain(column).map(|force| force.x);
        let found = found.chain(pairs.chunks(2).map(|pair| pair[0].x + pair[1].x));
        for (place, (found, expected)) in found.zip(expected).enumerate() {
            assert!((found - expected).abs() < most, "{place}: {found} for {expected}, {most:e}");
        }
    }
}
