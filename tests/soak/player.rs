//! A renderer of the host, what the host believes of it, and what its slots are drawn into.

use crate::common::host::{Host, HostBuffer};
use crate::kind::Kind;
use crate::log::Finding;
use crate::model::{Model, Thing};
use crate::random::Random;
use crate::surface::{Surface, target, words};
use crate::views::Seen;
use revmap::gpu::{Device, PreparedFrame, Renderer};
use std::rc::Rc;
use std::thread::JoinHandle;

/// A renderer with slots for all frames in flight and views.
pub struct Player<'a> {
    pub renderer: Renderer,
    pub kind: Rc<Kind>,
    pub model: Model,
    pub views: usize,
    /// One per slot.
    pub surfaces: Vec<Surface<'a>>,
    /// Targets of compute, of which the last is set. Earlier ones may be in use.
    pub words: Vec<HostBuffer<'a>>,
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
    /// True if all pipelines were compiled, and no technique has changed since.
    pub prewarmed: bool,
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
        let surfaces: Vec<_> = (0..slots).map(|_| Surface::new(host, &kind)).collect();
        let renderer = renderer(device, &kind, &surfaces[0], slots)?;
        let mut player = Self {
            renderer,
            model: Model::default(),
            views,
            surfaces,
            words: Vec::new(),
            depths: true,
            seen: vec![None; slots],
            tokens: (0..slots).map(|_| None).collect(),
            stale: None,
            hides: false,
            compiles: None,
            changed: true,
            prewarmed: false,
            spoilt: false,
            kind,
        };
        player.set_target(host, true)?;
        Ok(player)
    }

    /// Makes another renderer with the same content. The earlier frames are done.
    pub fn make_again(&mut self, host: &'a Host, device: &Device) -> Result<(), Finding> {
        self.join()?;
        // Two renderers at once for a moment, as after a change of settings.
        self.renderer = renderer(device, &self.kind, &self.surfaces[0], self.surfaces.len())?;
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
        (self.changed, self.prewarmed, self.spoilt) = (true, false, false);
        self.set_target(host, self.depths)
    }

    /// Gives compute another target. Nothing is done for other outputs.
    pub fn set_target(&mut self, host: &'a Host, depths: bool) -> Result<(), Finding> {
        if !self.kind.compute {
            return Ok(());
        }
        let new = words(host, &self.kind);
        // SAFETY: the buffer has two words for each pixel, and is kept until the renderer is gone.
        unsafe { self.renderer.set_compute_target(target(&new, depths)) }?;
        self.words.push(new);
        self.depths = depths;
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

fn renderer(
    device: &Device,
    kind: &Kind,
    surface: &Surface<'_>,
    slots: usize,
) -> revmap::Result<Renderer> {
    let pass = match kind.own_pass {
        true => surface.pass(),
        false => ash::vk::RenderPass::null(),
    };
    Renderer::new(device, kind.output(pass), &kind.search, slots)
}
