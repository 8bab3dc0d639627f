//! The tests of `grasp` that use it from outside, as one program.

mod allocation;
mod common;
mod conventions;
mod exact;
mod families;
mod following;
mod forces;
mod friction;
mod gradient;
mod properties;
mod reference;
mod robust;
mod truth;
