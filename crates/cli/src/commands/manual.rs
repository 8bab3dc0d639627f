//! `moduli completions` and `moduli man`: help for shells and manual readers.

use clap::CommandFactory;
use clap_mangen::Man;

use crate::args::{Arguments, CompletionOptions, ManOptions};
use crate::failure::Failure;
use crate::output;

/// Prints the completions of a shell.
pub(crate) fn completions(options: &CompletionOptions) -> Result<(), Failure> {
    let mut text = Vec::new();
    let mut command = Arguments::command();
    clap_complete::generate(options.shell, &mut command, "moduli", &mut text);
    output::say(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// Writes a manual page per command.
pub(crate) fn pages(options: &ManOptions) -> Result<(), Failure> {
    let mut command = Arguments::command();
    command.build();
    write_page(&command, options)
}

/// The page of a command, and those of the commands below it.
fn write_page(command: &clap::Command, options: &ManOptions) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or("moduli").to_owned();
    let mut text = Vec::new();
    Man::new(command.clone())
        .render(&mut text)
        .map_err(|e| Failure::other(format!("cannot write the manual: {e}")))?;
    let path = options.folder.join(format!("{name}.1"));
    output::write_file(&path, &text)?;
    output::say(path.display().to_string());
    let below = command.get_subcommands().filter(|c| c.get_name() != "help");
    for sub in below {
        write_page(sub, options)?;
    }
    Ok(())
}
