//! The page that shows every case as every method draws it.

use std::io::{self, Write};

use iso_render::{EncodeError, Look, Shading, srgb_from_color};

use super::measure::{Measured, Seen};
use crate::comparison::{Answers, Verdict};
use crate::html::{escaped, image_address};

/// What is painted over wrong answers.
const FALSE_HIT: [u8; 3] = [220, 30, 30];
const MISSED_ROOT: [u8; 3] = [250, 200, 0];

const HEAD: &str = "<!DOCTYPE html>
<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\"><title>iso stress</title>
<style>
body { font: 15px/1.4 system-ui, sans-serif; margin: 2em auto; padding: 0 1em; max-width: 60em; color: #222 }
h2 { margin-top: 2em } h3 { margin-bottom: 0 } code { overflow-wrap: anywhere }
.methods { display: grid; grid-template-columns: repeat(4, 1fr); gap: 1em }
@media (max-width: 40em) { .methods { grid-template-columns: 1fr 1fr } }
figure { margin: 0 } figcaption { font-size: 85%; color: #555 }
img { box-sizing: border-box; width: 100%; image-rendering: pixelated; border: 1px solid #ccc }
.broken { color: #b00 }
</style>
<h1>Hard cases</h1>
<p>Each case as each method draws it. Red: a hit where it is proven that there is no root. Yellow: a proven root that the method
missed. Green: a touch. Magenta: undecided.</p>
";

/// Writes a page that needs no other file.
pub(crate) fn write_page(writer: &mut dyn Write, measured: &[Measured]) -> io::Result<()> {
    writer.write_all(HEAD.as_bytes())?;
    for family in measured.chunk_by(|a, b| a.family == b.family) {
        writeln!(writer, "<h2>{}</h2><p>{}</p>", escaped(family[0].family), escaped(&family[0].about))?;
        family.iter().try_for_each(|case| write_case(writer, case))?;
    }
    writeln!(writer, "</html>")
}

fn write_case(writer: &mut dyn Write, case: &Measured) -> io::Result<()> {
    writeln!(writer, "<h3>{}</h3>", escaped(&case.name))?;
    writeln!(writer, "<p><code>{}</code><br>{}.", escaped(&case.formula), escaped(&case.hard))?;
    if let Some(reason) = &case.open {
        writeln!(writer, "<br>Rays may be left open: {}.", escaped(reason))?;
    }
    for problem in &case.broken {
        writeln!(writer, "<br><span class=\"broken\">Broken: {}</span>", escaped(problem))?;
    }
    writeln!(writer, "</p><div class=\"methods\">")?;
    for ((method, answers, verdicts), run) in case.view.methods.iter().zip(case.native()) {
        let picture = thumbnail(&case.view, answers, verdicts).map_err(io::Error::other)?;
        writeln!(
            writer,
            "<figure><img alt=\"\" src=\"{}\"><figcaption>{method}<br>{} wrong, {} missed, {} open<br>\
             {:.1} ms</figcaption></figure>",
            picture,
            run.wrong,
            run.missed,
            run.open(),
            run.milliseconds,
        )?;
    }
    writeln!(writer, "</div>")
}

/// The address of the picture, wrong answers painted over.
fn thumbnail(view: &Seen, answers: &Answers, verdicts: &[Verdict]) -> Result<String, EncodeError> {
    let shading = Shading::new(&view.camera, &Look { shows_statuses: true, ..Look::DEFAULT });
    let color = |pixel: usize| match verdicts[pixel] {
        Verdict::False => FALSE_HIT,
        Verdict::Missed => MISSED_ROOT,
        _ => {
            let (row, toward) = (pixel / view.size.width() as usize, view.rays[pixel].direction);
            let normal = answers.normals[pixel];
            let background = shading.background(row as u32, view.size);
            srgb_from_color(shading.color(&answers.outcomes.get(pixel), normal, toward, background))
        }
    };
    image_address(view.size, (0..view.rays.len()).map(color).collect())
}
