//! What a sweep means, in plain words.

use iso_grid::{Method, Outcome};
use iso_render::Picture;

use super::Run;

/// The runs that none beats both in time and in wrong pixels, from fast to slow.
pub(super) fn front(runs: &[Run]) -> Vec<&Run> {
    let mut sorted: Vec<&Run> = runs.iter().collect();
    sorted.sort_by(|one, other| {
        let time = one.milliseconds.median.total_cmp(&other.milliseconds.median);
        time.then(one.quality.wrong().cmp(&other.quality.wrong()))
    });
    let mut fewest = usize::MAX;
    sorted.retain(|run| {
        let is_better = run.quality.wrong() < fewest;
        fewest = fewest.min(run.quality.wrong());
        is_better
    });
    sorted
}

/// What to use for this formula, and what it costs.
pub(super) fn advice(runs: &[Run], pixels: usize) -> String {
    let front = front(runs);
    let (Some(fastest), Some(best)) = (front.first(), front.last()) else {
        return "Nothing was measured yet.".to_owned();
    };
    let time = |run: &Run| {
        let spread = run.milliseconds;
        format!("{:.1} ms ({:.1} to {:.1})", spread.median, spread.least, spread.greatest)
    };
    let wrong = |run: &Run| match run.quality.wrong() {
        0 => "no wrong pixel".to_owned(),
        1 => format!("1 of {pixels} pixels wrong"),
        wrong => format!("{wrong} of {pixels} pixels wrong"),
    };
    let mut text = format!("Use {}: {}, with {}.", best.setting.flags, time(best), wrong(best));
    if fastest.setting != best.setting {
        let flags = &fastest.setting.flags;
        text.push_str(&format!(" The fastest is {flags}: {}, with {}.", time(fastest), wrong(fastest)));
    }
    let proof = runs.iter().filter(|run| run.setting.method == Method::CERTIFIED);
    if let Some(proof) =
        proof.min_by(|one, other| one.milliseconds.median.total_cmp(&other.milliseconds.median))
        && proof.setting != best.setting
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
        if pair[0].milliseconds.greatest >= pair[1].milliseconds.least {
            let [one, other] = [0, 1].map(|place: usize| &pair[place].setting.flags);
            notes.push(format!("The machine was too noisy to rank by time: {one} and {other}."));
        }
    }
    if let Some(best) = front(runs).last() {
        let rivals = runs.iter().filter(|run| {
            run.setting != best.setting
                && run.quality.wrong() <= best.quality.wrong()
                && run.milliseconds.least <= best.milliseconds.greatest
        });
        let rivals: Vec<&str> = rivals.map(|run| run.setting.flags.as_str()).collect();
        if !rivals.is_empty() {
            notes.push(format!(
                "The machine was too noisy to say that {} is faster than {}.",
                best.setting.flags,
                rivals.join("; ")
            ));
        }
    }
    if let Some(run) = runs.iter().find(|run| run.repetitions < 3) {
        let times = if run.repetitions == 1 { "once" } else { "twice" };
        notes.push(format!("Some settings were measured only {times}: their spread says little."));
    }
    notes
}
