//! The command line.

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use iso_benches::surfaces::{SUBJECTS, Subject};
use iso_expr::Program;

use crate::iso::{EngineName, Method, Width};
use crate::model::read_model;

/// Compares this project with fidget, and with POV-Ray when it is installed.
#[derive(Debug, Parser)]
pub struct Arguments {
    /// Widths of the square pictures, in pixels.
    #[arg(long, value_delimiter = ',', default_value = "256,1024")]
    pub sizes: Vec<u32>,
    /// The surfaces, all by default.
    #[arg(long, value_delimiter = ',', value_parser = name_of_surface)]
    pub surfaces: Vec<String>,
    /// Models in fidget's text form, in place of the surfaces.
    #[arg(long, value_name = "PATH")]
    pub models: Vec<PathBuf>,
    /// Half the width of the models' pictures.
    #[arg(long, value_name = "LENGTH", default_value_t = 1.0)]
    pub radius: f64,
    /// How often each program renders each picture.
    #[arg(long, default_value_t = 7)]
    pub turns: usize,
    /// How often POV-Ray does, which takes seconds a picture; 0 leaves it out.
    #[arg(long, default_value_t = 1)]
    pub povray_turns: usize,
    /// Leaves fidget out.
    #[arg(long)]
    pub without_fidget: bool,
    /// Threads of every program.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, usize::from))]
    pub threads: usize,
    /// This project's method.
    #[arg(long, value_enum, default_value = "certified")]
    pub method: Method,
    /// How narrowly it encloses roots where it proves them.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "pixels,narrow")]
    pub widths: Vec<Width>,
    /// This project's engine.
    #[arg(long, value_enum, default_value = "jit")]
    pub engine: EngineName,
}

fn name_of_surface(name: &str) -> Result<String, String> {
    let names: Vec<_> = SUBJECTS.iter().map(|subject| subject.name).collect();
    let known = names.contains(&name);
    known.then(|| name.to_owned()).ok_or_else(|| format!("the surfaces are {}", names.join(", ")))
}

/// A formula to be rendered.
pub struct Body {
    /// Its name in tables.
    pub name: String,
    /// F, negative inside.
    pub program: Program,
    /// The radius of a ball around the origin that is in the picture.
    pub radius: f64,
}

impl Arguments {
    /// What is rendered.
    ///
    /// # Errors
    /// When a model cannot be read.
    pub fn subjects(&self) -> Result<Vec<Body>, Box<dyn Error>> {
        let body = |name: String, program, radius| Body { name, program, radius };
        if !self.models.is_empty() {
            let model = |path: &PathBuf| {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                Ok(body(name, read_model(path)?.simplified(), self.radius))
            };
            return self.models.iter().map(model).collect();
        }
        let is_wanted = |subject: &&Subject| {
            self.surfaces.is_empty() || self.surfaces.iter().any(|name| name == subject.name)
        };
        let surface =
            |subject: &Subject| Ok(body(subject.name.to_owned(), subject.program()?, subject.radius));
        SUBJECTS.iter().filter(is_wanted).map(surface).collect()
    }
}
