//! Runs every example.

#[path = "../../examples/01_fit.rs"]
mod fit;
#[path = "../../examples/03_grasp.rs"]
mod grasp;
#[path = "../../examples/05_own_hand.rs"]
mod own_hand;
#[path = "../../examples/02_quality.rs"]
mod quality;
#[path = "../../examples/04_transfer.rs"]
mod transfer;

#[test]
fn the_example_of_a_fit_runs() {
    fit::main().unwrap();
}

#[test]
fn the_example_of_qualities_runs() {
    quality::main().unwrap();
}

#[test]
fn the_example_of_grasps_runs() {
    grasp::main().unwrap();
}

#[test]
fn the_example_of_transfers_runs() {
    transfer::main().unwrap();
}

#[test]
fn the_example_of_an_own_hand_runs() {
    own_hand::main().unwrap();
}
