//! Changes of a renderer's objects and lights.

use super::Renderer;
use crate::error::{Error, ErrorKind, Result, content};
use crate::gpu::content::entry::{ObjectState, Stale};
use crate::gpu::content::objects::{ObjectId, named};
use crate::gpu::resources::textures::{HostImage, ObjectImages};
use crate::scene::{Copies, Lighting, Object, Offset, Placement, Shadow};
use crate::shader::generated::MAX_LIGHTS;

impl Renderer {
    /// Adds an object, which is drawn from the next prepared frame on, after all earlier objects.
    ///
    /// # Errors
    /// [`Content`](crate::error::ErrorKind::Content) for values out of range, with the key
    /// `object.N...`, where N counts objects in order, and the object's name;
    /// [`TooLarge`](crate::error::ErrorKind::TooLarge) for more copies than the device takes (its
    /// `maxStorageBufferRange` over [`INSTANCE_BYTES`](crate::gpu::INSTANCE_BYTES), over twice as many
    /// bytes with motion) or 2^24 objects.
    pub fn add(&mut self, object: Object) -> Result<ObjectId> {
        let objects = &mut self.content.objects;
        let checked = object.check();
        checked.map_err(|error| named(error, objects.len(), &object))?;
        objects.add(object)
    }

    /// Removes an object. Frames that were prepared earlier keep it until they are done.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.content.objects.remove(id)
    }

    /// The values of an object that were set last.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn object(&self, id: ObjectId) -> Result<&Object> {
        Ok(&self.content.objects.entry(id)?.set.object)
    }

    /// Sets all values of an object. Equal values cost nothing.
    ///
    /// # Errors
    /// [`Content`](crate::error::ErrorKind::Content) for values out of range, with the key and the name
    /// as in [`Renderer::add`]; [`Usage`](crate::error::ErrorKind::Usage) for an object that does not
    /// exist.
    pub fn set(&mut self, id: ObjectId, object: Object) -> Result<()> {
        self.accept(id, object.check())?;
        let latest = self.object(id)?;
        if latest.same_look(&object) {
            if latest.instances != object.instances {
                self.set_instances(id, object.instances)?;
            }
            return self.set_placement(id, object.placement);
        }
        self.content.objects.resize(id, object.placements().len())?;
        self.change(id, Stale::Shape)?.object = object;
        Ok(())
    }

    /// The values of an object, to be changed.
    fn change(&mut self, id: ObjectId, stale: Stale) -> Result<&mut ObjectState> {
        Ok(&mut self.content.objects.change(id, stale)?.set)
    }

    /// Names the object in the error of values that were checked for it.
    fn accept(&self, id: ObjectId, checked: Result<()>) -> Result<()> {
        checked.map_err(|error| self.content.objects.named(id, error))
    }

    /// Sets which views show an object: those whose [mask](crate::gpu::View::with_mask) shares a bit
    /// with `mask`. With 0 no view shows it. A hidden object throws no shadow. New objects are in all
    /// masks.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn set_mask(&mut self, id: ObjectId, mask: u32) -> Result<()> {
        if self.content.objects.entry(id)?.set.mask != mask {
            self.change(id, Stale::State)?.mask = mask;
        }
        Ok(())
    }

    /// Sets an image of the host as the colours of an object, in place of its
    /// [`color_map`](crate::scene::Texturing::color_map); `None` for that map again. The image's upper
    /// edge is at the top of the object, as a map's. What is read counts as linear: give sRGB texels a
    /// view of an `_SRGB` format. Frames that were prepared earlier keep their image.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn set_color_image(&mut self, id: ObjectId, image: Option<HostImage>) -> Result<()> {
        self.set_image(id, |images| images.color = image)
    }

    /// Sets an image of the host as the slopes of an object, in place of its
    /// [`displacement_map`](crate::scene::Texturing::displacement_map); `None` for that map again. The
    /// first two channels are the slopes of heights, as a
    /// [`DisplacementMap`](crate::maps::DisplacementMap) has them: `dH/du` and `dH/dv` per unit of
    /// texture coordinate, `v` upwards. It replaces an image of heights.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn set_slope_image(&mut self, id: ObjectId, image: Option<HostImage>) -> Result<()> {
        self.set_image(id, |images| {
            (images.relief, images.heights) = (image, false)
        })
    }

    /// Same as [`Renderer::set_slope_image`], for an image whose first channel is heights, 0 to 1. Each
    /// pixel reads it four times: an image of slopes is faster. It replaces an image of slopes.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) for an object that does not exist.
    pub fn set_height_image(&mut self, id: ObjectId, image: Option<HostImage>) -> Result<()> {
        self.set_image(id, |images| {
            (images.relief, images.heights) = (image, true);
        })
    }

    fn set_image(&mut self, id: ObjectId, set: impl FnOnce(&mut ObjectImages)) -> Result<()> {
        set(&mut self.change(id, Stale::Look)?.images);
        Ok(())
    }

    /// Moves the surface of an object.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_offset(&mut self, id: ObjectId, offset: Offset) -> Result<()> {
        self.accept(id, offset.check())?;
        if self.object(id)?.offset != offset {
            self.change(id, Stale::Shape)?.object.offset = offset;
        }
        Ok(())
    }

    /// Moves an object that has one copy.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_placement(&mut self, id: ObjectId, placement: Placement) -> Result<()> {
        self.accept(id, placement.check())?;
        if self.object(id)?.placement != placement {
            self.change(id, Stale::State)?.object.placement = placement;
        }
        Ok(())
    }

    /// Sets the copies of an object. An empty list gives one copy, at the object's placement.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_instances(&mut self, id: ObjectId, instances: impl Into<Copies>) -> Result<()> {
        let instances = instances.into();
        self.accept(id, instances.check())?;
        self.content.objects.resize(id, instances.len().max(1))?;
        self.change(id, Stale::State)?.object.instances = instances;
        Ok(())
    }

    /// Ends a frame of all views: the next frame's motion is that from the present values. Call it
    /// before the next frame's changes. Objects that were added since the last call begin without
    /// motion. Copy `k` is copy `k` of the last frame; an object with another
    /// number of copies has no motion of its own in that frame. Without this call no object moves.
    /// Outputs without [`Plane::Motion`](crate::settings::Plane::Motion) need no call.
    pub fn end_frame(&mut self) {
        self.content.objects.end_frame();
    }

    /// Sets lights, environment and shadows for all objects.
    ///
    /// # Errors
    /// [`Content`](crate::error::ErrorKind::Content) for values out of range, with the key;
    /// [`Usage`](crate::error::ErrorKind::Usage) for shadows if a function of the host shades.
    pub fn set_lighting(&mut self, lighting: &Lighting) -> Result<()> {
        lighting.check()?;
        if self.content.host_shades && lighting.shadow != Shadow::Off {
            let message = "the host's function shades without shadows between solids; set \"off\"";
            return Err(Error::new(ErrorKind::Usage, message).at_key("shadow"));
        }
        let (count, most) = (lighting.lights.len(), MAX_LIGHTS);
        if count > most as usize {
            return content("light", format!("{count} lights; at most {most} are drawn"));
        }
        let selects = |of: &Lighting| (of.shadow, of.environment.is_some());
        self.content.objects.stale |= selects(lighting) != selects(&self.content.lighting);
        self.content.lighting = lighting.clone();
        Ok(())
    }
}
