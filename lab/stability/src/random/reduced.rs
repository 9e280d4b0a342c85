//! Failing scenes made smaller.

use super::Draft;
use revmap::error::Result;
use revmap::gpu::Device;
use std::path::Path;

impl Draft {
    /// The same with one part less, in every way there is.
    fn smaller(&self) -> Vec<Self> {
        let mut all = Vec::new();
        let mut without = |count: usize, remove: &dyn Fn(&mut Self, usize)| {
            for k in 0..count {
                let mut one = self.clone();
                remove(&mut one, k);
                all.push(one);
            }
        };
        if self.objects.len() > 1 {
            without(self.objects.len(), &|d, k| drop(d.objects.remove(k)));
        }
        without(self.lines.len(), &|d, k| drop(d.lines.remove(k)));
        without(self.lights.len(), &|d, k| _ = d.lights.remove(k));
        for (n, object) in self.objects.iter().enumerate() {
            let keys = |d: &mut Self, k| drop(d.objects[n].keys.remove(k));
            without(object.keys.len(), &keys);
            let copies = |d: &mut Self, k| _ = d.objects[n].copies.remove(k);
            without(object.copies.len(), &copies);
            let corners = |d: &mut Self, k| _ = d.objects[n].polygon.remove(k);
            without(object.polygon.len(), &corners);
        }
        all
    }

    /// The smallest scene that still fails, taking away one part at a time.
    pub fn reduced(&self, device: &Device, folder: &Path) -> Result<Self> {
        let mut now = self.clone();
        'again: loop {
            for smaller in now.smaller() {
                if smaller.fails(device, folder)?.is_some() {
                    now = smaller;
                    continue 'again;
                }
            }
            return Ok(now);
        }
    }
}
