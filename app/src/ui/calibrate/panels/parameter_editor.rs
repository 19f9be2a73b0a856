//! The editor of one parameter: a trial value is simulated at once, and prior knowledge is set here.

use crate::text::format::{self, Quantity};
use crate::ui::calibrate::state::Calibration;
use crate::ui::calibrate::what_if::residual_rms;
use crate::ui::calibrate::what_if_actions;
use crate::ui::document::fit_choice::Stated;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::tooltips;
use crate::ui::kit::widgets::{call, card, compact, segmented};
use egui::{Align, DragValue, Layout, RichText, Slider, Ui};
use estimator::estimate::Parameter;
use haptics::recording::Prior;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const CLOSE: &str = "Close";
    pub const NO_VALUE: &str = "It has no value that could be varied: state one below.";
    pub const TRY_ANOTHER_VALUE: &str = "Try another value";
    pub const ANOTHER_VALUE: &str = "Another value";
    pub const ANOTHER_VALUE_AS_A_NUMBER: &str = "Another value, as a number";
    pub const THE_SIMULATED_CURVES: &str = "The simulated curves and what is left over follow the slider.";
    pub const REPLAYING: &str = "Replaying …";
    pub const BACK_TO_THE_FITTED: &str = "Back to the fitted value";
    pub const WHERE_ITS_VALUE: &str = "Where its value comes from";
    pub const ESTIMATE: &str = "Estimate";
    pub const ESTIMATE_MORE: &str = "From this recording alone";
    pub const PRIOR: &str = "Prior";
    pub const PRIOR_MORE: &str = "From this recording and what was believed before, each by its error";
    pub const FREEZE: &str = "Freeze";
    pub const FREEZE_MORE: &str = "Taken as known exactly; not estimated";
    pub const VALUE: &str = "Value";
    pub const MEAN: &str = "Mean";
    pub const NOT_BELOW: &str = "Not below";
    pub const NOT_ABOVE: &str = "Not above";
}

/// Half-range of the slider in standard errors.
const SIGMAS: f64 = 6.0;
/// Minimum half-range of the slider, as a share of the value.
const SHARE: f64 = 0.5;

/// Source of a parameter's value.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    Estimated,
    Prior,
    Known,
}

/// Draws the card of the selected parameter, if there is one.
pub fn selected(ui: &mut Ui, calibration: &mut Calibration) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    let Some(name) = calibration.selected_parameter.clone() else { return };
    let Some(parameter) = analysis.fit.parameters.iter().find(|p| p.full_name() == name) else { return };
    let quantity = format::parameter(&parameter.name, parameter.value);
    let heading = format!("{} · {}", format::object(&parameter.object), quantity.label.to_lowercase());
    let mut close = false;
    let leave = |ui: &mut Ui| close = ui.link(words::CLOSE).clicked();
    card(ui, &heading, leave, |ui| {
        if let Some(lesson) = tooltips::parameter(&parameter.name) {
            ui.label(theme::caption(ui, format!("{} {}", lesson.what, lesson.formula)));
            ui.add_space(space::XS);
        }
        try_another(ui, calibration, parameter, &quantity);
        ui.add_space(space::S);
        state(ui, calibration, parameter, &quantity);
    });
    if close {
        calibration.selected_parameter = None;
    }
}

fn try_another(ui: &mut Ui, calibration: &mut Calibration, parameter: &Parameter, quantity: &Quantity) {
    let name = parameter.full_name();
    let Some(fitted) = parameter.value.filter(|_| parameter.identified) else {
        ui.label(theme::caption(ui, words::NO_VALUE));
        return;
    };
    ui.label(theme::strong(words::TRY_ANOTHER_VALUE));
    let tried = calibration.what_if.values.get(&name).copied();
    let reach = (SIGMAS * parameter.std_error.unwrap_or(0.0)).max(SHARE * fitted.abs()).max(1e-9);
    let mut shown = tried.unwrap_or(fitted) * quantity.factor;
    let range = (fitted - reach) * quantity.factor..=(fitted + reach) * quantity.factor;
    let digits = (2.0 - (reach * quantity.factor).log10().floor()).clamp(0.0, 8.0) as usize;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 108.0).max(60.0);
        let slider = Slider::new(&mut shown, range).show_value(false);
        let slid = ui.add(slider.clamping(egui::SliderClamping::Never));
        let number = DragValue::new(&mut shown).speed(0.01 * reach * quantity.factor).max_decimals(digits);
        let typed = ui.add(number.suffix(format!(" {}", quantity.unit)));
        call(&slid, words::ANOTHER_VALUE);
        call(&typed, words::ANOTHER_VALUE_AS_A_NUMBER);
        if slid.changed() || typed.changed() {
            what_if_actions::try_value(calibration, &name, Some(shown / quantity.factor));
        }
    });
    outcome(ui, calibration, tried.is_some());
}

/// Draws the force residual of the trial values, beside that of the fit.
fn outcome(ui: &mut Ui, calibration: &mut Calibration, here: bool) {
    if !calibration.what_if.is_on() {
        ui.label(theme::caption(ui, words::THE_SIMULATED_CURVES));
        return;
    }
    let p = palette(ui);
    let (fitted, tried) = (residual_rms(&calibration.replays), residual_rms(&calibration.what_if.replays));
    if let (Some(fitted), Some(tried)) = (fitted, tried) {
        let change = 100.0 * (tried / fitted.max(1e-12) - 1.0);
        let color = if change > 1.0 { p.caution } else { p.good };
        let words = format!(
            "{} N RMS left over · fitted {} N · {}{} %",
            format::significant(tried, 3),
            format::significant(fitted, 3),
            if change >= 0.0 { "+" } else { "−" },
            format::number(change.abs(), 1),
        );
        ui.label(RichText::new(words).size(11.5).color(color));
    } else {
        ui.label(theme::caption(ui, words::REPLAYING));
    }
    let several = calibration.what_if.values.len() - usize::from(here);
    compact(ui, |ui| {
        if ui.link(words::BACK_TO_THE_FITTED).clicked() {
            calibration.what_if.forget();
        }
        if several > 0 {
            ui.label(theme::caption(ui, format!("{several} more tried")));
        }
    });
}

fn state(ui: &mut Ui, calibration: &mut Calibration, parameter: &Parameter, quantity: &Quantity) {
    let name = Stated::name_of(parameter);
    let stated = &mut calibration.choice.stated;
    let before = if stated.known.contains_key(&name) {
        Source::Known
    } else if stated.prior.contains_key(&name) {
        Source::Prior
    } else {
        Source::Estimated
    };
    ui.label(theme::strong(words::WHERE_ITS_VALUE));
    let choices = [
        (Source::Estimated, (Icon::Fit, words::ESTIMATE), words::ESTIMATE_MORE),
        (Source::Prior, (Icon::Adjust, words::PRIOR), words::PRIOR_MORE),
        (Source::Known, (Icon::Lock, words::FREEZE), words::FREEZE_MORE),
    ];
    let mut source = before;
    if segmented(ui, &mut source, &choices) {
        stated.known.remove(&name);
        stated.prior.remove(&name);
        // The slider's value is the one to keep.
        let value = calibration.what_if.values.get(&parameter.full_name()).copied().or(parameter.value).unwrap_or(0.0);
        let std = parameter.std_error.filter(|e| *e > 0.0).unwrap_or_else(|| (0.1 * value.abs()).max(1e-6));
        match source {
            Source::Known => drop(stated.known.insert(name.clone(), value)),
            Source::Prior => drop(stated.prior.insert(name.clone(), Prior { mean: value, std })),
            Source::Estimated => {}
        }
    }
    if let Some(value) = stated.known.get_mut(&name) {
        line(ui, words::VALUE, quantity.unit, |ui| number(ui, value, quantity, None));
    }
    if let Some(prior) = stated.prior.get_mut(&name) {
        line(ui, words::MEAN, quantity.unit, |ui| number(ui, &mut prior.mean, quantity, None));
        line(ui, "± 1 σ", quantity.unit, |ui| number(ui, &mut prior.std, quantity, Some(1e-12)));
    }
    bounds(ui, stated, &name, parameter, quantity);
}

fn bounds(ui: &mut Ui, stated: &mut Stated, name: &str, parameter: &Parameter, quantity: &Quantity) {
    let mut pair = stated.bounds.get(name).copied().unwrap_or([None, None]);
    let value = parameter.value.unwrap_or(0.0);
    let reach = parameter.std_error.map_or(0.1 * value.abs(), |e| 3.0 * e).max(1e-9);
    for (index, (words, start)) in
        [(words::NOT_BELOW, value - reach), (words::NOT_ABOVE, value + reach)].into_iter().enumerate()
    {
        compact(ui, |ui| {
            let mut on = pair[index].is_some();
            if ui.checkbox(&mut on, RichText::new(words).size(12.0)).changed() {
                pair[index] = on.then_some(start);
            }
            if let Some(bound) = &mut pair[index] {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    ui.label(theme::caption(ui, quantity.unit));
                    number(ui, bound, quantity, None);
                });
            }
        });
    }
    if let [Some(low), Some(high)] = &mut pair
        && *low > *high
    {
        std::mem::swap(low, high);
    }
    if pair == [None, None] {
        stated.bounds.remove(name);
    } else {
        stated.bounds.insert(name.to_owned(), pair);
    }
}

fn line(ui: &mut Ui, label: &str, unit: &str, value: impl FnOnce(&mut Ui)) {
    compact(ui, |ui| {
        ui.label(theme::caption(ui, label));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(theme::caption(ui, unit));
            value(ui);
        });
    });
}

/// Draws a number field: stored in SI, shown in the quantity's unit.
fn number(ui: &mut Ui, value: &mut f64, quantity: &Quantity, least: Option<f64>) {
    let mut shown = *value * quantity.factor;
    let speed = (0.005 * shown.abs()).max(1e-5);
    let low = least.map_or(f64::NEG_INFINITY, |least| least * quantity.factor);
    let field = DragValue::new(&mut shown).speed(speed).max_decimals(6).range(low..=f64::INFINITY);
    if ui.add(field).changed() {
        *value = shown / quantity.factor;
    }
}
