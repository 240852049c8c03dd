//! How long certified pictures take by their size, by the number of operations and by the number of threads.

mod operations;
mod picture;
mod plot;
mod sizes;

use std::error::Error;

use iso_benches::machine::Machine;

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Machine::here();
    println!("{machine}");
    sizes::measure(&machine)?;
    operations::measure(&machine)
}
