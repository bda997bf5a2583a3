//! Cubes alone: those whose centre is inside the shape, on one lattice along the axes. The surface is a stair.
//!
//! For what needs equal cells, such as particles on a lattice. Of cubes that hang together by edges or corners alone the
//! largest part, by faces, is kept.

use std::collections::BTreeMap;

use souple_math::Vec3;

use crate::implicit::Shape;
use crate::{ElementKind, Mesh};

/// Corners of a cube in the order of a hexahedron.
const CORNERS: [[i64; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// The cubes of an edge of `size` metres.
pub(super) fn voxels(shape: &dyn Shape, size: f64) -> Mesh {
    let bounds = shape.bounds();
    let counts = bounds.size().to_array().map(|length| (length / size).ceil().max(1.0) as i64);
    // the lattice is about the middle of the bounds
    let middle = (bounds.low + bounds.high) * 0.5;
    let place = |index: [i64; 3]| {
        let from_middle = |axis: usize| (index[axis] as f64 - 0.5 * counts[axis] as f64) * size;
        middle + Vec3::new(from_middle(0), from_middle(1), from_middle(2))
    };
    let half = Vec3::new(0.5, 0.5, 0.5) * size;
    // zero where no part has been found yet
    let mut part_of: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                if shape.value(place([x, y, z]) + half) <= 0.0 {
                    part_of.insert([x, y, z], 0);
                }
            }
        }
    }
    let kept = largest_part(&mut part_of);
    let mut mesh = Mesh::default();
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    for (cube, _) in part_of.iter().filter(|(_, part)| **part == kept) {
        let nodes = CORNERS.map(|corner| {
            let index = [0, 1, 2].map(|axis| cube[axis] + corner[axis]);
            *numbers.entry(index).or_insert_with(|| {
                mesh.points.push(place(index));
                mesh.points.len() as u32 - 1
            })
        });
        mesh.push_cell(ElementKind::Hex8, &nodes);
    }
    mesh
}

/// Numbers the parts that hang together by faces, from 1; the number of the largest, the first of equal ones.
fn largest_part(part_of: &mut BTreeMap<[i64; 3], usize>) -> usize {
    let cubes: Vec<[i64; 3]> = part_of.keys().copied().collect();
    let (mut largest, mut part) = ((0, 0), 0);
    for start in cubes {
        if part_of.get(&start) != Some(&0) {
            continue;
        }
        part += 1;
        let mut count = 0;
        let mut open = vec![start];
        part_of.insert(start, part);
        while let Some(cube) = open.pop() {
            count += 1;
            for axis in 0..3 {
                for step in [-1, 1] {
                    let mut beside = cube;
                    beside[axis] += step;
                    if let Some(own) = part_of.get_mut(&beside).filter(|own| **own == 0) {
                        *own = part;
                        open.push(beside);
                    }
                }
            }
        }
        if count > largest.0 {
            largest = (count, part);
        }
    }
    largest.1
}
