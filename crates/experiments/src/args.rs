//! The command line that all experiments share.

use std::path::PathBuf;

use clap::{CommandFactory, FromArgMatches, Parser};
use grasp::Convention;

use crate::objects::ObjectSource;
use crate::run::Scale;

/// Options of an experiment.
#[derive(Clone, Debug, Parser, PartialEq)]
#[command(version)]
pub struct Args {
    /// The built-in catalogue, or a folder whose .ply files are taken in the order of their names
    /// (metres)
    #[arg(long, value_name = "builtin|FOLDER", default_value = "builtin", value_parser = object_source)]
    pub objects: ObjectSource,
    /// Use only these objects, by id: S1 to S12, or names of files without .ply
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    pub only: Vec<String>,
    /// How much to compute: a few seconds, or everything that the paper computed
    #[arg(long, value_enum, default_value = "small")]
    pub scale: Scale,
    /// Seed of all random numbers: the same seed gives the same numbers on any number of threads
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// How grasp quality is measured: paper, graspit, dexnet, frogger, openrave or unit
    #[arg(long, default_value = "paper", value_parser = Convention::named)]
    pub convention: Convention,
    /// Highest degree L of the surfaces
    #[arg(long, default_value_t = crate::paper::DEGREE, value_parser = parse_degree)]
    pub degree: usize,
    /// Penalty λ of the fits; chosen from the data when absent
    #[arg(long)]
    pub lambda: Option<f64>,
    /// Threads to use; all processors when absent
    #[arg(long)]
    pub threads: Option<usize>,
    /// No progress on stderr
    #[arg(short, long)]
    pub quiet: bool,
}

impl Args {
    /// Reads the arguments of a program of this name; `about` is its line of help.
    pub fn read<I, T>(name: &'static str, about: &'static str, args: I) -> Result<Self, clap::Error>
    where
        I: IntoIterator<Item = T>,
        T: Into<std::ffi::OsString> + Clone,
    {
        let command = Self::command().name(name).about(about);
        Self::from_arg_matches(&command.try_get_matches_from(args)?)
    }
}

fn object_source(text: &str) -> Result<ObjectSource, std::convert::Infallible> {
    Ok(match text {
        "builtin" => ObjectSource::Builtin,
        folder => ObjectSource::Folder(PathBuf::from(folder)),
    })
}

fn parse_degree(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(degree @ 1..=200) => Ok(degree),
        _ => Err("expected a whole number from 1 to 200".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(args: &[&str]) -> Result<Args, clap::Error> {
        let all = std::iter::once("test").chain(args.iter().copied());
        Args::read("test", "a test", all)
    }

    #[test]
    fn defaults_are_the_small_run_of_the_paper_on_built_in_objects() {
        let args = read(&[]).unwrap();
        assert_eq!(args.objects, ObjectSource::Builtin);
        assert_eq!((args.scale, args.seed), (Scale::Small, 1));
        assert_eq!(args.out, PathBuf::from("out"));
        assert_eq!(args.convention.name, "paper");
        assert_eq!((args.degree, args.lambda), (crate::paper::DEGREE, None));
        assert_eq!((args.threads, args.quiet), (None, false));
        assert!(args.only.is_empty());
    }

    #[test]
    fn everything_can_be_chosen() {
        let args = read(&[
            "--objects",
            "scans",
            "--only",
            "cup,can",
            "--scale",
            "full",
            "--seed",
            "9",
            "--out",
            "there",
            "--convention",
            "dexnet",
            "--threads",
            "3",
            "-q",
        ])
        .unwrap();
        assert_eq!(args.objects, ObjectSource::Folder(PathBuf::from("scans")));
        assert_eq!(args.only, ["cup", "can"]);
        assert_eq!((args.scale, args.seed), (Scale::Full, 9));
        assert_eq!(args.convention.name, "dexnet");
        assert_eq!((args.threads, args.quiet), (Some(3), true));
    }

    #[test]
    fn mistakes_are_usage_errors() {
        for wrong in [
            ["--scale", "huge"],
            ["--convention", "mine"],
            ["--seed", "x"],
            ["--degree", "0"],
        ] {
            assert_eq!(read(&wrong).unwrap_err().exit_code(), 2);
        }
        assert!(
            read(&["--convention", "mine"])
                .unwrap_err()
                .to_string()
                .contains("frogger")
        );
    }
}
