//! Laws that a scene writes: evaluated link by link, with as much memory as they like up to a bound.

use std::fmt::Debug;

use souple_engine::LinkState;
use souple_formal::{CONSTANTS, FUNCTIONS, Formula, parse_quantity, quantity_in};
use souple_math::Vec3;

use super::kernel::{LinkKernel, Moving};
use super::law::{AsksFor, LinkError, Moment, Reach, Response};
use super::layout::{LANES, Part};
use super::span::{Between, Known, OnAxis, Projected};

/// Most numbers that a written law remembers of a link.
pub const WRITTEN_MEMORY: usize = 16;

/// A law whose text is read when the scene is.
pub trait WrittenLaw: Debug + Send + Sync + 'static {
    /// At most [`WRITTEN_MEMORY`].
    fn memory_len(&self) -> usize;
    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]);
    fn is_conservative(&self) -> bool;
    /// `memory` becomes that of the next step.
    fn respond(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> Response;
    /// `∂φ/∂D` and `∂φ/∂D^r` [N/m].
    fn slopes(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> [f64; 2];
    /// See [`super::LinkLaw::stiffest`]; of a link of this rest length.
    fn stiffest(&self, rest: f64) -> f64;
    /// What holds a link together that remembers this.
    fn state(&self, _memory: &[f64]) -> LinkState {
        LinkState::In(0)
    }
    /// Whether it asks where ends are.
    fn asks_for(&self) -> AsksFor {
        AsksFor::default()
    }
    /// The distance [m] beyond which a link that remembers this does nothing and remembers the same: there its length is not
    /// computed, and with it no square root.
    fn idle_from(&self, _memory: &[f64]) -> Option<f64> {
        None
    }
    /// See [`LinkKernel::begins_with`].
    fn begins_with(&self) -> &[&'static str] {
        &[]
    }
    /// See [`LinkKernel::registers`].
    fn registers(&self) -> Vec<&str> {
        Vec::new()
    }
    /// The same law with another value in a register; nothing is allocated.
    fn with_register(&self, _register: usize, _value: f64) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }
}

/// Distances of a pair at which the slope of a written law is looked at.
const DISTANCES: usize = 16;

/// [`LinkKernel`] of a written law.
#[derive(Debug)]
pub struct OneByOne<L>(pub L);

impl<L: WrittenLaw> OneByOne<L> {
    /// What acts on the first end of the part's `slot`-th link, and what its law says; rows and `memory` are the part's,
    /// `numbers` become the link's of the next step.
    fn act<B: Between>(
        &self,
        part: &Part,
        rows: B,
        slot: usize,
        memory: &[f64],
        numbers: &mut [f64; WRITTEN_MEMORY],
    ) -> (B::Load, Response) {
        let (len, (block, lane)) = (self.0.memory_len(), part.place(slot));
        let ends = part.places_of(slot);
        for i in 0..len {
            numbers[i] = memory[(block * len + i) * LANES + lane];
        }
        if let Some(idle) = self.0.idle_from(&numbers[..len])
            && rows.are_beyond(ends, idle)
        {
            return (B::Load::default(), Response { push: 0.0, stored: 0.0, heat: 0.0 });
        }
        let (length, before, direction) = rows.one(ends);
        let reach = Reach { length, before, rest: part.rest(block)[lane] };
        let moment = match self.0.asks_for() == AsksFor::default() {
            true => Moment::of(rows.time()),
            false => Moment { time: rows.time(), places: rows.both(ends) },
        };
        let response = self.0.respond(&reach, &moment, &mut numbers[..len]);
        (B::scaled(direction, response.push), response)
    }

    fn add<B: Between>(&self, part: &Part, rows: B, memory: &[f64], sums: &mut [B::Load]) {
        let (rows, mut numbers) = (rows.of_part(part), [0.0; WRITTEN_MEMORY]);
        for slot in 0..part.links.len() {
            let (load, _) = self.act(part, rows, slot, memory, &mut numbers);
            B::add_to(sums, part.places_of(slot), load);
        }
    }

    fn write<B: Between>(&self, part: &Part, rows: B, memory: &[f64], out: &mut [B::Load]) {
        let (rows, mut numbers) = (rows.of_part(part), [0.0; WRITTEN_MEMORY]);
        for slot in 0..part.links.len() {
            let (block, lane) = part.place(slot);
            out[block * LANES + lane] = self.act(part, rows, slot, memory, &mut numbers).0;
        }
    }

    fn move_on<B: Between>(&self, part: &Part, rows: B, memory: &mut [f64]) -> f64 {
        let (rows, len, mut numbers) = (rows.of_part(part), self.0.memory_len(), [0.0; WRITTEN_MEMORY]);
        let mut heat = 0.0;
        for slot in 0..part.links.len() {
            let (block, lane) = part.place(slot);
            heat += self.act(part, rows, slot, memory, &mut numbers).1.heat;
            for i in 0..len {
                memory[(block * len + i) * LANES + lane] = numbers[i];
            }
        }
        heat
    }
}

impl<L: WrittenLaw> LinkKernel for OneByOne<L> {
    fn memory_len(&self) -> usize {
        self.0.memory_len()
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        self.0.begin(rest, length, memory);
    }

    fn is_conservative(&self) -> bool {
        self.0.is_conservative()
    }

    fn stiffest(&self, rest: f64) -> f64 {
        self.0.stiffest(rest)
    }

    // H(-1) = -∂φ/∂D + ∂φ/∂D^r, as pairs begin, at several distances: the curve may bend anywhere
    fn stiffest_within(&self, range: f64) -> f64 {
        let mut numbers = [0.0; WRITTEN_MEMORY];
        let memory = &mut numbers[..self.0.memory_len()];
        self.0.begin(range, range, memory);
        let at = |length: f64| {
            let reach = Reach { length, before: length, rest: range };
            let [now, before] = self.0.slopes(&reach, &Moment::of(0.0), memory);
            before - now
        };
        let lengths = (0..DISTANCES).map(|i| range * (0.5 + 0.5 * (i as f64 + 0.5) / DISTANCES as f64));
        // where a formula has no slope nothing is told
        lengths.map(at).filter(|slope| slope.is_finite()).fold(self.0.stiffest(range), f64::max)
    }

    fn state(&self, _: &Reach, memory: &[f64]) -> LinkState {
        self.0.state(&memory[..self.0.memory_len()])
    }

    fn add_forces(&self, part: &Part, moving: Moving, memory: &[f64], sums: &mut [Vec3]) {
        self.add(part, moving, memory, sums);
    }

    fn forces(&self, part: &Part, moving: Moving, memory: &[f64], out: &mut [Vec3]) {
        self.write(part, moving, memory, out);
    }

    fn advance(&self, part: &Part, moving: Moving, memory: &mut [f64]) -> f64 {
        self.move_on(part, moving, memory)
    }

    fn add_pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], sums: &mut [f64]) {
        self.add(part, on_axis, memory, sums);
    }

    fn pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], out: &mut [f64]) {
        self.write(part, on_axis, memory, out);
    }

    fn advance_along(&self, part: &Part, on_axis: OnAxis<Projected>, memory: &mut [f64]) -> f64 {
        self.move_on(part, on_axis, memory)
    }

    fn respond_and_remember(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> Response {
        self.0.respond(reach, moment, memory)
    }

    fn slopes(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> [f64; 2] {
        self.0.slopes(reach, moment, &memory[..self.0.memory_len()])
    }

    fn asks_for(&self) -> AsksFor {
        self.0.asks_for()
    }

    fn begins_with(&self) -> &[&'static str] {
        self.0.begins_with()
    }

    fn registers(&self) -> Vec<&str> {
        self.0.registers()
    }

    fn driven(&self, values: &[(usize, f64)], act: &mut dyn FnMut(&dyn LinkKernel)) {
        let mut law: Option<L> = None;
        for (register, value) in values {
            let changed = law.as_ref().unwrap_or(&self.0).with_register(*register, *value);
            law = changed.or(law);
        }
        match law {
            Some(law) => act(&OneByOne(law)),
            None => act(self),
        }
    }
}

/// Most numbers that formulas of a law may refer to.
pub const ARGUMENTS: usize = 64;

/// What formulas read: variables, what is remembered, parameters.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<T> {
    values: [T; ARGUMENTS],
    len: usize,
}

impl<T: Copy> Arguments<T> {
    /// `zero` fills what is not used.
    pub fn new(zero: T, values: impl IntoIterator<Item = T>) -> Self {
        let mut arguments = Self { values: [zero; ARGUMENTS], len: 0 };
        for value in values {
            arguments.values[arguments.len] = value;
            arguments.len += 1;
        }
        arguments
    }

    pub fn as_slice(&self) -> &[T] {
        &self.values[..self.len]
    }

    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values[..self.len]
    }
}

/// Numbers under names, in SI units, that formulas may refer to, beside `others` of which some are `known`.
///
/// # Errors
/// A number that cannot be read or is not finite; too many of them; a name that is known already.
pub fn constants<'a>(
    texts: &'a [(String, String)],
    others: usize,
    known: &[&str],
) -> Result<(Vec<&'a str>, Vec<f64>), LinkError> {
    check_names("parameters", texts.iter().map(|(name, _)| name.as_str()), known)?;
    if texts.len() + others > ARGUMENTS {
        let what = format!("are {}; at most {}", texts.len(), ARGUMENTS - others);
        return Err(LinkError::text("parameters", what));
    }
    let mut values = Vec::with_capacity(texts.len());
    for (name, text) in texts {
        let place = || format!("parameters.{name}");
        let value = match parse_quantity(text) {
            Ok(quantity) => quantity.value,
            Err(_) => formula(&place(), text, &[])?.evaluate(&[]),
        };
        if !value.is_finite() {
            return Err(LinkError::text(place(), format!("is {value}: give a finite number")));
        }
        values.push(value);
    }
    Ok((texts.iter().map(|(name, _)| name.as_str()).collect(), values))
}

/// Refuses parameters that a law does not name: misspelt ones, that would change nothing.
///
/// # Errors
/// The first of them, with those that `naming` is said of, such as "`push` names".
pub fn refuse_unnamed(
    names: &[&str],
    naming: &str,
    is_named: impl Fn(usize) -> bool,
) -> Result<(), LinkError> {
    let Some(unnamed) = (0..names.len()).find(|at| !is_named(*at)) else { return Ok(()) };
    let known: Vec<String> =
        (0..names.len()).filter(|at| is_named(*at)).map(|at| format!("`{}`", names[at])).collect();
    let known =
        if known.is_empty() { "no parameter".to_owned() } else { format!("{} alone", known.join(", ")) };
    Err(LinkError::text(
        format!("parameters.{}", names[unnamed]),
        format!("changes nothing: {naming} {known}"),
    ))
}

/// A number that is written with or without a unit, in SI units; `None` of what is a formula.
///
/// # Errors
/// Its unit is of another kind than `unit`, in words.
pub fn number_in(text: &str, unit: &str) -> Option<Result<f64, String>> {
    let quantity = parse_quantity(text).ok()?;
    if text.trim().parse::<f64>().is_ok() {
        return Some(Ok(quantity.value));
    }
    Some(quantity_in(text, unit).map_err(|error| error.to_string()))
}

/// Refuses names that formulas know already: variables, constants and functions.
///
/// # Errors
/// The first such name.
pub fn check_names<'a>(
    place: &str,
    names: impl IntoIterator<Item = &'a str>,
    known: &[&str],
) -> Result<(), LinkError> {
    let constants = || CONSTANTS.iter().map(|(name, _)| *name);
    let functions = || FUNCTIONS.iter().map(|function| function.name);
    for name in names {
        let what = match name {
            _ if known.contains(&name) => "a variable of the law",
            _ if constants().any(|constant| constant == name) => "a constant",
            _ if functions().any(|function| function == name) => "a function",
            _ => continue,
        };
        let what = format!("has the name of {what}: take another");
        return Err(LinkError::text(format!("{place}.{name}"), what));
    }
    Ok(())
}

/// Reads a formula of `variables`.
pub fn formula(place: &str, text: &str, variables: &[&str]) -> Result<Formula, LinkError> {
    formula_within(place, text, text, variables)
}

/// Reads a formula that is a piece of a text: a slice of it. Faults are told by their place in the text.
pub fn formula_within(
    place: &str,
    text: &str,
    piece: &str,
    variables: &[&str],
) -> Result<Formula, LinkError> {
    Formula::compile(piece, variables).map_err(|error| LinkError::Formula {
        place: place.to_owned(),
        begin: begin_within(text, piece),
        error: Box::new(error),
    })
}

/// Where a slice of a text begins in it [bytes]; 0 where it is none.
pub fn begin_within(text: &str, piece: &str) -> usize {
    let begin = (piece.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
    if begin <= text.len() { begin } else { 0 }
}
