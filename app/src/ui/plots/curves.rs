//! Curves of a plot: measured, simulated, extended, those of other recordings, and the residuals of the models.

use super::choices::{GroupChoice, Overlaid, PlotChoices, unit_after};
use super::derived::{Derived, Recipe};
use super::levels::Levels;
use super::noise::sigma;
use crate::ui::calibrate::replayed::Replayed;
use crate::ui::document::prepared::{Group, Prepared, Trace};
use estimator::pipeline::Analysis;
use estimator::segment::Segmentation;
use estimator::signal::transform::Transform;
use std::collections::HashMap;
use std::sync::Arc;

/// Source of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layer {
    /// The shown recording.
    Measured,
    /// Simulation of the measured motion in the fitted world.
    Simulated,
    /// Simulation of the measured motion in the extended world, which includes the diagnosed causes.
    Extended,
    /// Another recording, by its index among the overlaid ones.
    Other(usize),
    /// Residual of the fitted world: measured minus simulated.
    LeftSimulated,
    /// Residual of the extended world: measured minus extended.
    LeftExtended,
}

impl Layer {
    /// Name of the layer's visibility switch; `None` where single curves are hidden.
    pub fn switch(self) -> Option<&'static str> {
        match self {
            Self::Simulated | Self::LeftSimulated => Some("layer: simulated"),
            Self::Extended | Self::LeftExtended => Some("layer: extended"),
            Self::Measured | Self::Other(_) => None,
        }
    }
}

/// Name of the visibility switch of the noise band.
pub const NOISE_SWITCH: &str = "layer: noise";

/// One curve of a plot.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Index of its trace in the group.
    pub trace: usize,
    /// Source of the curve.
    pub layer: Layer,
    /// Its values.
    pub levels: Arc<Levels>,
    /// Recording of the curve.
    pub prepared: Arc<Prepared>,
    /// Time offset added to its times, s.
    pub offset_s: f64,
    /// Standard deviation of the measured curve's noise, in the shown unit, where a model is compared with it.
    pub sigma: Option<f64>,
}

/// The curves of one plot.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// Curves in drawing order.
    pub curves: Vec<Curve>,
    /// Their unit.
    pub unit: String,
    /// Transform that was applied to them.
    pub transform: Transform,
    /// True while newer curves are being computed.
    pub pending: bool,
}

impl Drawn {
    /// True when there is a curve of this layer.
    pub fn has(&self, layer: Layer) -> bool {
        self.curves.iter().any(|c| c.layer == layer)
    }
}

/// Sources of the curves.
#[derive(Clone, Copy)]
pub struct Sources<'a> {
    /// All loaded recordings.
    pub recordings: &'a [Arc<Prepared>],
    /// The shown one.
    pub prepared: &'a Arc<Prepared>,
    /// Simulation in the fitted world.
    pub simulated: Option<&'a Replayed>,
    /// Simulation in the extended world.
    pub extended: Option<&'a Replayed>,
    /// Fit, with the segmentation of the shown recording.
    pub analysis: Option<(&'a Arc<Analysis>, &'a Segmentation)>,
}

/// Cache of measured noise, by curve and fit; both live as long as their entry.
#[derive(Debug, Default)]
pub struct NoiseCache(HashMap<(usize, usize), Remembered>);

#[derive(Debug)]
struct Remembered {
    sigma: Option<f64>,
    _of: (Arc<Levels>, Option<Arc<Analysis>>),
}

/// Limit of the cache, above the number of curves that any window shows.
const MOST_REMEMBERED: usize = 256;

impl NoiseCache {
    fn sigma(&mut self, raw: &Levels, drawn: &Arc<Levels>, sources: &Sources<'_>, transform: Transform) -> Option<f64> {
        let analysis = sources.analysis.map(|(analysis, _)| analysis);
        let key = (Arc::as_ptr(drawn) as usize, analysis.map_or(0, |a| Arc::as_ptr(a) as usize));
        if self.0.len() > MOST_REMEMBERED {
            self.0.clear();
        }
        let remembered = self.0.entry(key).or_insert_with(|| Remembered {
            sigma: sigma(raw, drawn, sources.prepared, sources.analysis.map(|(_, s)| s), transform),
            _of: (Arc::clone(drawn), analysis.cloned()),
        });
        remembered.sigma
    }
}

/// Curves of a group's plot, and those of the residual plot below it. The second is `None` where it is switched off or
/// where there is no model to compare.
pub fn curves(sources: &Sources<'_>, choices: &mut PlotChoices, group: &Group) -> (Drawn, Option<Drawn>) {
    let choice = choices.of(group).clone();
    let PlotChoices { derived, noise, overlaid, .. } = choices;
    let build = Build { sources, choice: &choice, group, overlaid };
    // The previous curves stay while the new ones are computed.
    let wanted = build.main(derived, choice.transform, true);
    let mut main = wanted.unwrap_or_else(|| {
        let before = build.main(derived, choice.drawn, false);
        let drawn = before.or_else(|| build.main(derived, Transform::None, false)).unwrap_or_default();
        Drawn { pending: true, ..drawn }
    });
    build.measure_noise(noise, &mut main);
    let left = choice.left_over.then(|| build.left(derived, &main)).filter(|l| l.pending || !l.curves.is_empty());
    choices.of(group).drawn = main.transform;
    (main, left)
}

struct Build<'a> {
    sources: &'a Sources<'a>,
    choice: &'a GroupChoice,
    group: &'a Group,
    overlaid: &'a [Overlaid],
}

impl Build<'_> {
    fn shown(&self) -> impl Iterator<Item = (usize, &Trace)> {
        self.group.traces.iter().enumerate().filter(|(_, t)| self.choice.shows(&t.name))
    }

    /// A layer of a trace before any transform.
    fn of_model(&self, trace: &Trace, layer: Layer) -> Option<&Arc<Levels>> {
        let replay = match layer {
            Layer::Simulated | Layer::LeftSimulated => self.sources.simulated?,
            _ => self.sources.extended?,
        };
        replay.curves.iter().find(|(name, _)| *name == trace.name).map(|(_, levels)| levels)
    }

    fn is_on(&self, layer: Layer) -> bool {
        layer.switch().is_none_or(|switch| self.choice.shows(switch))
    }

    fn recipe(&self, of: &Arc<Levels>, transform: Transform) -> Recipe {
        Recipe { prepared: Arc::clone(self.sources.prepared), of: Arc::clone(of), less: None, transform }
    }

    /// Every curve of the plot; `None` while one of them is still missing. With `ask` the missing ones are requested.
    fn main(&self, derived: &mut Derived, transform: Transform, ask: bool) -> Option<Drawn> {
        let mut wanted: Vec<(usize, Layer, f64, Recipe)> = Vec::new();
        for layer in [Layer::Simulated, Layer::Extended].into_iter().filter(|l| self.is_on(*l)) {
            for (t, trace) in self.shown() {
                if let Some(of) = self.of_model(trace, layer) {
                    wanted.push((t, layer, 0.0, self.recipe(of, transform)));
                }
            }
        }
        for (place, other) in self.overlaid.iter().enumerate() {
            self.others(place, other, transform, &mut wanted);
        }
        for (t, trace) in self.shown() {
            wanted.push((t, Layer::Measured, 0.0, self.recipe(&trace.levels, transform)));
        }
        let mut missing = false;
        let mut drawn = Vec::with_capacity(wanted.len());
        for (trace, layer, offset_s, recipe) in wanted {
            // All missing curves are requested at once.
            match if ask { derived.get(&recipe) } else { derived.peek(&recipe) } {
                Some(levels) => {
                    drawn.push(Curve { trace, layer, levels, prepared: recipe.prepared, offset_s, sigma: None });
                }
                None => missing = true,
            }
        }
        let clockless = self.sources.prepared.clockless();
        let unit = unit_after(&self.group.unit, transform.order(), clockless);
        (!missing).then_some(Drawn { curves: drawn, unit, transform, pending: false })
    }

    /// Curves of the same signals in another recording.
    fn others(
        &self,
        place: usize,
        other: &Overlaid,
        transform: Transform,
        wanted: &mut Vec<(usize, Layer, f64, Recipe)>,
    ) {
        let Some(prepared) = self.sources.recordings.get(other.recording) else { return };
        let Some(group) = prepared.groups.iter().find(|g| g.key() == self.group.key()) else { return };
        for (t, trace) in self.shown() {
            if let Some(same) = group.traces.iter().find(|s| s.name == trace.name) {
                let recipe =
                    Recipe { prepared: Arc::clone(prepared), of: Arc::clone(&same.levels), less: None, transform };
                wanted.push((t, Layer::Other(place), other.offset_s, recipe));
            }
        }
    }

    /// Sets the noise of each model curve: the standard deviation of the measured curve beside it.
    fn measure_noise(&self, cache: &mut NoiseCache, drawn: &mut Drawn) {
        let measured: Vec<(usize, Arc<Levels>)> = drawn
            .curves
            .iter()
            .filter(|c| c.layer == Layer::Measured)
            .map(|c| (c.trace, Arc::clone(&c.levels)))
            .collect();
        for curve in drawn.curves.iter_mut().filter(|c| matches!(c.layer, Layer::Simulated | Layer::Extended)) {
            let Some((_, levels)) = measured.iter().find(|(trace, _)| *trace == curve.trace) else { continue };
            let raw = &self.group.traces[curve.trace].levels;
            curve.sigma = cache.sigma(raw, levels, self.sources, drawn.transform);
        }
    }

    /// Residuals of the models, with the transform of the measured curves.
    fn left(&self, derived: &mut Derived, main: &Drawn) -> Drawn {
        let mut left = Drawn { unit: main.unit.clone(), transform: main.transform, ..Drawn::default() };
        for layer in [Layer::LeftSimulated, Layer::LeftExtended].into_iter().filter(|l| self.is_on(*l)) {
            for (t, trace) in self.shown() {
                let Some(model) = self.of_model(trace, layer) else { continue };
                let recipe = Recipe { less: Some(Arc::clone(model)), ..self.recipe(&trace.levels, main.transform) };
                match derived.get(&recipe) {
                    Some(levels) => {
                        let sigma =
                            main.curves.iter().find(|c| c.trace == t && c.sigma.is_some()).and_then(|c| c.sigma);
                        let prepared = Arc::clone(self.sources.prepared);
                        left.curves.push(Curve { trace: t, layer, levels, prepared, offset_s: 0.0, sigma });
                    }
                    None => left.pending = true,
                }
            }
        }
        left
    }
}

/// True if a model predicts a curve of the group, so that there is something to compare.
pub fn can_compare(replay: Option<&Replayed>, group: &Group) -> bool {
    replay.is_some_and(|r| group.traces.iter().any(|t| r.curves.iter().any(|(name, _)| *name == t.name)))
}
