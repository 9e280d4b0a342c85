//! A renderer of the host, what the host believes of it, and what its slots are drawn into.

use crate::common::host::{Canvas, Host};
use crate::kind::Kind;
use crate::log::Finding;
use crate::model::{Model, Thing};
use crate::random::Random;
use crate::views::Seen;
use revmap::gpu::{Device, PreparedFrame, Renderer};
use std::collections::BTreeSet;
use std::rc::Rc;
use std::thread::JoinHandle;

/// A renderer with slots for all frames in flight and views.
pub struct Player<'a> {
    pub renderer: Renderer,
    pub kind: Rc<Kind>,
    pub model: Model,
    pub views: usize,
    /// One per slot.
    pub canvases: Vec<Canvas<'a>>,
    /// True if compute compares depths.
    pub depths: bool,
    /// The view that each slot showed last.
    pub seen: Vec<Option<Seen>>,
    /// The last token of each slot.
    pub tokens: Vec<Option<PreparedFrame>>,
    /// The token of an earlier frame.
    pub stale: Option<PreparedFrame>,
    pub hides: bool,
    /// A compilation on another thread.
    pub compiles: Option<JoinHandle<revmap::Result<()>>>,
    /// True if something was set since the last frame that was submitted.
    pub changed: bool,
    /// The techniques of which all pipelines are compiled.
    pub prewarmed: BTreeSet<String>,
    /// True if the renderer is to be dropped and made again after this frame.
    pub spoilt: bool,
}

impl<'a> Player<'a> {
    pub fn new(
        (host, device): (&'a Host, &Device),
        dice: &mut Random,
        frames: usize,
    ) -> Result<Self, Finding> {
        let kind = Rc::new(Kind::random(dice));
        let views = dice.pick(&[1, 1, 1, 2, 3]);
        let slots = frames * views;
        let canvases: Vec<_> = (0..slots).map(|_| kind.canvas(host)).collect();
        Ok(Self {
            renderer: renderer(device, &kind, &canvases)?,
            model: Model::default(),
            views,
            canvases,
            depths: true,
            seen: vec![None; slots],
            tokens: (0..slots).map(|_| None).collect(),
            stale: None,
            hides: false,
            compiles: None,
            changed: true,
            prewarmed: BTreeSet::new(),
            spoilt: false,
            kind,
        })
    }

    /// Makes another renderer with the same content. The earlier frames are done.
    pub fn make_again(&mut self, device: &Device) -> Result<(), Finding> {
        self.join()?;
        // Two renderers at once for a moment, as after a change of settings.
        self.renderer = renderer(device, &self.kind, &self.canvases)?;
        self.renderer.hide_until_compiled(self.hides);
        for thing in &mut self.model.things {
            thing.last = None;
        }
        let ids = self.model.add_to(&mut self.renderer)?;
        for (thing, id) in self.model.things.iter_mut().zip(ids) {
            thing.id = id;
        }
        // `add_to` ended a frame.
        self.model.end_frame();
        (self.changed, self.spoilt) = (true, false);
        self.prewarmed.clear();
        Ok(())
    }

    /// Waits for the other thread.
    pub fn join(&mut self) -> Result<(), Finding> {
        match self.compiles.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(result)) => Ok(result?),
            Some(Err(_)) => Err(Finding("the thread that compiles panicked".into())),
        }
    }

    /// True if something is set that no frame may have.
    pub fn fresh(&self) -> bool {
        self.changed || self.model.things.is_empty()
    }

    pub fn thing(&mut self, n: usize) -> &mut Thing {
        &mut self.model.things[n]
    }
}

impl Drop for Player<'_> {
    fn drop(&mut self) {
        // The renderer outlives the compilation.
        let _ = self.join();
    }
}

fn renderer(device: &Device, kind: &Kind, canvases: &[Canvas<'_>]) -> revmap::Result<Renderer> {
    let pass = match &canvases[0] {
        Canvas::Pass(into) if kind.own_pass => into.pass,
        _ => ash::vk::RenderPass::null(),
    };
    Renderer::new(device, kind.output(pass), &kind.search, canvases.len())
}
