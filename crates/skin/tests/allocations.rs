//! A step of a skin allocates nothing once its buffers are there: counted by the allocator itself, on one thread.

use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::cell::Cell;

use souple_math::Vec3;
use souple_skin::strategy::TERMS;
use souple_skin::target::particles::Density;
use souple_skin::target::{ISO, Moment, Part, Particle, Particles, Target};
use souple_skin::{Lattice, Skin};
use souple_table::{Value, Values};

/// Counts what the thread at hand asks of the heap.
struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: all is passed on to the system's allocator; the count is a thread's own number without a destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller's promises are passed on
        unsafe { Heap.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above
        unsafe { Heap.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as above
        unsafe { Heap.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A tense skin over particles that go to and fro through the grid, so that blocks wake and sleep: after a period of that none
/// of the next asks for memory.
#[test]
fn steps_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let term = |name: &str, strength: f64| {
            let mut values = Values::new();
            values.set("strength".to_owned(), Value::Number(strength));
            let entry = TERMS.find(name).unwrap();
            (entry.build)(&entry.values(values).unwrap()).unwrap()
        };
        let particle = |i: i32| Particle {
            position: Vec3::new((i % 4).into(), (i / 4 % 4).into(), (i / 16).into()) * 0.2,
            velocity: Vec3::ZERO,
            radius: 0.1,
            during: [f64::NEG_INFINITY, f64::INFINITY],
        };
        let density = Density { particles: Particles::Led((0..64).map(particle).collect()) };
        let to_and_fro = ["0.5*sin(6.283185307179586*t)", "0", "0"]
            .map(|text| souple_formal::Formula::compile(text, &["t"]).unwrap());
        let part = Part { motion: Some(to_and_fro), ..Part::new(Box::new(density)) };
        let skin = Skin {
            name: "skin".to_owned(),
            lattice: Lattice { origin: Vec3::ZERO, voxel: 0.05 },
            target: Some(Target { parts: vec![part], iso: ISO }),
            terms: vec![term("attraction", 20.0), term("tension", 0.002)],
            redistance: 0.25,
            reaction: None,
        };
        let target = skin.target.as_ref().unwrap();
        let mut placed = target.new_scratch();
        target.place(&Moment::at(0.0), &mut placed).unwrap();
        let bounds = target.bounds(&placed).unwrap();
        let mut scratch = skin.new_scratch();
        let excess = |point| target.excess(point, &placed);
        let mut field = skin.start(bounds.low, bounds.high, &excess, &mut scratch).unwrap();
        let mut period = |first: i32| {
            let before = COUNT.get();
            for step in first + 1..=first + 50 {
                let end = Moment::at(f64::from(step) * 0.02);
                skin.step(&end, 0.02, &mut field, &mut scratch).unwrap();
            }
            COUNT.get() - before
        };
        let (warm_up, next) = (period(0) + period(50), period(100));
        // the counter counts
        assert!(warm_up > 0);
        assert_eq!(next, 0);
    });
}
