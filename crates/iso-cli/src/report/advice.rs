//! What a sweep means, in plain words.

use iso_grid::{Method, Outcome};
use iso_render::Picture;

use super::Run;

/// How many times as long a run may take to count as about as fast.
const ABOUT_AS_FAST: f64 = 1.1;
/// How many times as far from proven roots found ones may be to count as about as good.
const ABOUT_AS_GOOD: f64 = 10.0;

/// How many settings a note names.
const MOST_RIVALS: usize = 4;

/// The runs that none beats both in time and in wrong pixels, from fast to slow.
pub(super) fn front(runs: &[Run]) -> Vec<&Run> {
    front_by(runs, |run| run.quality.wrong() as f64)
}

/// The runs that none beats both in time and in an error, from fast to slow. Those without an error are left out.
pub(super) fn front_by(runs: &[Run], error: impl Fn(&Run) -> f64) -> Vec<&Run> {
    let mut sorted: Vec<&Run> = runs.iter().filter(|run| !error(run).is_nan()).collect();
    sorted.sort_by(|one, other| {
        let time = one.time().median.total_cmp(&other.time().median);
        time.then(error(one).total_cmp(&error(other)))
    });
    let mut least = f64::INFINITY;
    sorted.retain(|run| {
        let is_better = error(run) < least;
        least = least.min(error(run));
        is_better
    });
    sorted
}

/// The fastest run with the fewest wrong pixels, unless another one that is about as fast finds roots much better.
fn recommended(runs: &[Run]) -> Option<&Run> {
    let best = *front(runs).last()?;
    let distance = |run: &Run| run.quality.distance.p999;
    let is_about_as_fast = |run: &&Run| {
        run.quality.wrong() == best.quality.wrong() && run.time().median <= ABOUT_AS_FAST * best.time().median
    };
    let rivals = || runs.iter().filter(is_about_as_fast);
    let least = rivals().map(distance).fold(f64::INFINITY, f64::min);
    let is_about_as_good = |run: &&Run| distance(run).is_nan() || distance(run) <= ABOUT_AS_GOOD * least;
    rivals().filter(is_about_as_good).min_by(|one, other| one.time().median.total_cmp(&other.time().median))
}

/// What to use for this formula, and what it costs.
pub(super) fn advice(runs: &[Run], pixels: usize) -> String {
    let front = front(runs);
    let (Some(fastest), Some(best)) = (front.first(), recommended(runs)) else {
        return "Nothing was measured yet.".to_owned();
    };
    let time = |run: &Run| {
        let spread = run.time();
        format!("{:.1} ms ({:.1} to {:.1})", spread.median, spread.least, spread.greatest)
    };
    let wrong = |run: &Run| {
        let pixels = match run.quality.wrong() {
            0 => "no wrong pixel".to_owned(),
            1 => format!("1 of {pixels} pixels wrong"),
            wrong => format!("{wrong} of {pixels} pixels wrong"),
        };
        match run.quality.distance.p999 {
            distance if distance.is_nan() => pixels,
            distance => format!("{pixels} and roots to {distance:.0e}"),
        }
    };
    let mut text = format!("Use {}: {}, with {}.", best.setting.flags, time(best), wrong(best));
    if fastest.setting != best.setting {
        let flags = &fastest.setting.flags;
        text.push_str(&format!(" The fastest is {flags}: {}, with {}.", time(fastest), wrong(fastest)));
    }
    let is_proven = |run: &&Run| matches!(run.setting.method, Method::Certified { .. });
    let proof = runs.iter().filter(is_proven);
    if let Some(proof) = proof.min_by(|one, other| one.time().median.total_cmp(&other.time().median))
        && !is_proven(&best)
    {
        let flags = &proof.setting.flags;
        text.push_str(&format!(" To have it proven, use {flags}: {}.", time(proof)));
    }
    text
}

/// What to know before the figures are trusted.
pub(super) fn notes(runs: &[Run], proven: &Picture) -> Vec<String> {
    let mut notes = Vec::new();
    let open = proven.outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Undecided(_))).count();
    if open > 0 {
        notes.push(format!(
            "The certified method could not decide {open} of {} pixels; they are counted as open.",
            proven.outcomes.len()
        ));
    }
    for pair in front(runs).windows(2) {
        if pair[0].time().greatest >= pair[1].time().least {
            let [one, other] = [0, 1].map(|place: usize| &pair[place].setting.flags);
            notes.push(format!("The machine was too noisy to rank by time: {one} and {other}."));
        }
    }
    if let Some(best) = recommended(runs) {
        let rivals = runs.iter().filter(|run| {
            run.setting != best.setting
                && run.quality.wrong() <= best.quality.wrong()
                && run.time().least <= best.time().greatest
        });
        let rivals: Vec<&str> = rivals.map(|run| run.setting.flags.as_str()).collect();
        if !rivals.is_empty() {
            let (few, more) = rivals.split_at(rivals.len().min(MOST_RIVALS));
            let more = if more.is_empty() { String::new() } else { format!("; and {} more", more.len()) };
            notes.push(format!(
                "The machine was too noisy to say that {} is faster than {}{more}.",
                best.setting.flags,
                few.join("; ")
            ));
        }
    }
    if let Some(run) = runs.iter().find(|run| run.repetitions < 3) {
        let times = if run.repetitions == 1 { "once" } else { "twice" };
        notes.push(format!("Some settings were measured only {times}: their spread says little."));
    }
    notes
}
