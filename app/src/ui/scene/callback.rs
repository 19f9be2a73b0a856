//! An egui paint callback that draws a scene into a texture of its own and copies it into egui's pass.

use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor, wgpu};
use haptics::world::{State, World};
use render::{Blit, Frame, Renderer, SAMPLES, SceneView, TextureTarget, ViewOptions};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};

/// Format of the texture that the scene is drawn into.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Format of egui's target: kept in the context so that every panel can draw.
#[derive(Clone, Copy)]
struct Surface(wgpu::TextureFormat);

fn surface_id() -> egui::Id {
    egui::Id::unique("touchstone surface format")
}

/// Stores the window's target format for the panels. Without it, pictures are replaced by a sentence.
pub fn announce(ctx: &egui::Context, state: &egui_wgpu::RenderState) {
    ctx.data_mut(|data| data.insert_temp(surface_id(), Surface(state.target_format)));
}

/// Builds the scene renderer on a thread of its own after the window's first frame, which need not wait for it. Scenes
/// are omitted until it is ready.
pub fn warm_up(ctx: &egui::Context, state: &egui_wgpu::RenderState) {
    let warming = Warming { ctx: ctx.clone(), stage: Mutex::new(Stage::FirstPicture) };
    state.renderer.write().callback_resources.insert(warming);
}

/// Progress of the renderer's construction.
struct Warming {
    ctx: egui::Context,
    stage: Mutex<Stage>,
}

enum Stage {
    FirstPicture,
    Next,
    Building(Receiver<Resources>),
}

/// Draws a scene into `rect`; false if there is no graphics device. `view` distinguishes several pictures in one
/// window.
pub fn picture(
    ui: &egui::Ui,
    rect: egui::Rect,
    view: &'static str,
    world: Arc<World>,
    state: State,
    options: ViewOptions,
) -> bool {
    let Some(Surface(surface)) = ui.data(|data| data.get_temp(surface_id())) else { return false };
    let size = pixels(ui, rect);
    let callback = Picture { view, surface, size, world, state, options };
    ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, callback));
    true
}

/// Size of a rectangle in pixels.
pub fn pixels(ui: &egui::Ui, rect: egui::Rect) -> [u32; 2] {
    let size = rect.size() * ui.pixels_per_point();
    [size.x.round().max(1.0) as u32, size.y.round().max(1.0) as u32]
}

struct Picture {
    view: &'static str,
    surface: wgpu::TextureFormat,
    size: [u32; 2],
    world: Arc<World>,
    state: State,
    options: ViewOptions,
}

/// Renderer resources, stored in egui's renderer as long as the window lives.
struct Resources {
    renderer: Renderer,
    blit: Blit,
    views: HashMap<&'static str, ViewResources>,
}

struct ViewResources {
    frame: Frame,
    target: TextureTarget,
    bound: wgpu::BindGroup,
}

impl Warming {
    /// Takes the built resources once; `None` until they are ready, and where they cannot be built.
    fn take(&self, device: &wgpu::Device, surface: wgpu::TextureFormat) -> Option<Resources> {
        let mut stage = self.stage.lock().ok()?;
        match &*stage {
            Stage::FirstPicture => {
                *stage = Stage::Next;
                self.ctx.request_repaint();
                None
            }
            Stage::Next => {
                *stage = Stage::Building(self.build(device.clone(), surface));
                None
            }
            Stage::Building(receiver) => receiver.try_recv().ok(),
        }
    }

    fn build(&self, device: wgpu::Device, surface: wgpu::TextureFormat) -> Receiver<Resources> {
        let (sender, receiver) = channel();
        let ctx = self.ctx.clone();
        let work = move || {
            match Resources::tried(&device, surface) {
                // Nobody listens any more if the window was closed at once.
                Some(made) => drop(sender.send(made)),
                // Panels show a message in the picture's place.
                None => ctx.data_mut(|data| data.remove::<Surface>(surface_id())),
            }
            ctx.request_repaint();
        };
        if std::thread::Builder::new().name("pipelines".to_owned()).spawn(work).is_err() {
            self.ctx.data_mut(|data| data.remove::<Surface>(surface_id()));
        }
        receiver
    }
}

impl Resources {
    /// `None` where the graphics driver lacks what the pictures need.
    fn tried(device: &wgpu::Device, surface: wgpu::TextureFormat) -> Option<Self> {
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = Self::new(device, surface);
        pollster::block_on(scope.pop()).is_none().then_some(made)
    }

    fn new(device: &wgpu::Device, surface: wgpu::TextureFormat) -> Self {
        Self {
            renderer: Renderer::new(device, FORMAT, SAMPLES),
            blit: Blit::new(device, surface),
            views: HashMap::new(),
        }
    }

    fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture,
    ) {
        let Self { renderer, blit, views } = self;
        let view = views.entry(picture.view).or_insert_with(|| {
            let target = TextureTarget::new(device, FORMAT, SAMPLES, picture.size);
            ViewResources { frame: renderer.frame(device), bound: blit.bind(device, &target), target }
        });
        if view.target.resize(device, picture.size) {
            view.bound = blit.bind(device, &view.target);
        }
        let scene = SceneView { world: &picture.world, state: &picture.state, options: &picture.options };
        renderer.prepare(device, queue, &mut view.frame, &scene, picture.size);
        renderer.render(encoder, &view.target, &mut view.frame);
    }
}

impl CallbackTrait for Picture {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if !resources.contains::<Resources>() {
            let made = match resources.get::<Warming>() {
                Some(warming) => warming.take(device, self.surface),
                // Without a window, waiting is allowed.
                None => Some(Resources::new(device, self.surface)),
            };
            let Some(made) = made else { return Vec::new() };
            resources.insert(made);
        }
        if let Some(own) = resources.get_mut::<Resources>() {
            own.prepare(device, queue, encoder, self);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(own) = resources.get::<Resources>() else { return };
        if let Some(view) = own.views.get(self.view) {
            own.blit.draw(pass, &view.bound);
        }
    }
}
