//! Answers about real measurements are right, or honest.

use tests::real::{Outcome, QUESTIONS, ask};

#[test]
fn answers_about_real_measurements_are_right_or_honest() {
    use rayon::prelude::*;
    let answers: Vec<_> = QUESTIONS.par_iter().filter_map(|question| Some((question, ask(question)?))).collect();
    let mut wrong = Vec::new();
    for (question, judged) in &answers {
        println!("{} {}: {} ({})", question.log, question.asked, judged.said, judged.outcome.word());
        if judged.outcome == Outcome::Wrong {
            wrong.push(format!("{} {}: {}", question.log, question.asked, judged.said));
        }
    }
    // The offset of one motor by its measured torque is 2.2 errors from that of a plain fit.
    assert!(wrong.len() <= 1, "{wrong:#?}");
    let right = answers.iter().filter(|(_, judged)| judged.outcome == Outcome::Right).count();
    assert!(10 * right >= 7 * answers.len(), "{right} of {} right", answers.len());
}
