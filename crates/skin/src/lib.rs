//! A skin: the zero level of a potential on a sparse grid, moved by strategies, with tension, area and volume of its own.

mod cases;
mod crossings;
mod grid;
mod polygons;
