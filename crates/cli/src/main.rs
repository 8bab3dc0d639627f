//! `moduli`: grasps on a user's own objects, from the command line.

mod args;
mod commands;
mod failure;
mod files;
mod hands;
mod input;
mod library_folder;
mod limits;
mod mesh_folders;
mod moved;
mod movement;
mod outcomes;
mod output;
mod page;
mod result;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Arguments, Command, HandCommand};
use crate::failure::Failure;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::report_failure(&failure);
            failure.exit_code()
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let common = &arguments.common;
    rayon::ThreadPoolBuilder::new()
        .num_threads(common.threads.unwrap_or(0))
        .build_global()
        .map_err(|e| Failure::other(format!("cannot start threads: {e}")))?;
    match &arguments.command {
        Command::Fit(options) => commands::fit::run(options, common),
        Command::Eval(options) => commands::eval::run(options, common),
        Command::Mesh(options) => commands::mesh::run(options),
        Command::Distance(options) => commands::distance::run(options, common),
        Command::Quality(options) => commands::quality::run(options, common),
        Command::Ascend(options) => commands::ascend::run(options, common),
        Command::Transfer(options) => commands::transfer::run(options, common),
        Command::Synthesize(options) => commands::synthesize::run(options, common),
        Command::Hand(HandCommand::Check(options)) => commands::hand_check::run(options, common),
        Command::Hand(HandCommand::Init(options)) => commands::hand_init::run(options, common),
        Command::Grasp(options) => commands::grasp::run(options, common),
        Command::Library(command) => commands::library::run(command, common),
        Command::Export(options) => commands::export::run(options, common),
        Command::Info(options) => commands::info::run(options, common),
        Command::Completions(options) => commands::manual::completions(options),
        Command::Man(options) => commands::manual::pages(options),
    }
}
