//! Registers for values: a register is free again after its last use.

use std::collections::HashMap;

use super::lower::{Lowered, Place, Step};
use super::{Instruction, Tape};

/// Free registers by how many numbers they hold in a row.
#[derive(Default)]
struct Free {
    by_size: HashMap<usize, Vec<u32>>,
    next: u32,
}

impl Free {
    fn take(&mut self, size: usize) -> u32 {
        if let Some(register) = self.by_size.get_mut(&size).and_then(Vec::pop) {
            return register;
        }
        let register = self.next;
        self.next += size as u32;
        register
    }
}

pub(super) fn assign(lowered: Lowered) -> Tape {
    let Lowered { sizes, steps, constants, inputs, outputs, .. } = lowered;
    let split = steps[0].len();
    let steps: Vec<Step> = steps.into_iter().flatten().collect();
    let mut computed_again = vec![false; sizes.len()];
    steps[split..].iter().for_each(|step| computed_again[step.out.value] = true);
    // the last step that reads each value; what outlives the tape is read behind its end
    let mut last_use = vec![0; sizes.len()];
    for (index, step) in steps.iter().enumerate() {
        for operand in step.operands.iter().flatten() {
            // the second part runs again and again: what it reads from the first must stay
            let computed_before = index >= split && !computed_again[operand.value];
            last_use[operand.value] =
                if computed_before { usize::MAX } else { last_use[operand.value].max(index) };
        }
        last_use[step.out.value] = last_use[step.out.value].max(index);
    }
    let given = || constants.iter().map(|(place, _)| place).chain(inputs.iter().flatten());
    given().chain(&outputs).for_each(|place| last_use[place.value] = usize::MAX);

    let mut free = Free::default();
    let mut registers: Vec<Option<u32>> = vec![None; sizes.len()];
    for place in given() {
        if registers[place.value].is_none() {
            registers[place.value] = Some(free.take(sizes[place.value]));
        }
    }
    let mut instructions = Vec::with_capacity(steps.len());
    for (index, step) in steps.iter().enumerate() {
        let out = step.out.value;
        if registers[out].is_none() {
            // while an instruction runs its result must not lie on its operands
            registers[out] = Some(free.take(sizes[out]));
        }
        let register = |place: Place| registers[place.value].unwrap_or(0) + place.offset;
        let mut operands = [0; 5];
        for (slot, operand) in operands.iter_mut().zip(step.operands.iter().flatten()) {
            *slot = register(*operand);
        }
        instructions.push(Instruction {
            code: step.code,
            entries: step.entries,
            out: register(step.out),
            operands,
        });
        let ended = |value: &usize| last_use[*value] == index;
        let mut done: Vec<usize> =
            step.operands.iter().flatten().map(|place| place.value).chain([out]).filter(ended).collect();
        done.sort_unstable();
        done.dedup();
        for value in done {
            if let Some(register) = registers[value] {
                free.by_size.entry(sizes[value]).or_default().push(register);
            }
        }
    }
    let register = |place: &Place| registers[place.value].unwrap_or(0) + place.offset;
    Tape {
        split,
        registers: free.next as usize,
        constants: constants.iter().map(|(place, value)| (register(place), *value)).collect(),
        inputs: inputs.each_ref().map(|places| places.iter().map(register).collect()),
        outputs: outputs.iter().map(register).collect(),
        instructions,
    }
}
