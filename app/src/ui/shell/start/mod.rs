//! Starting the window on any screen: what the environment asks for, and what to do when no window opens.

pub mod again;
pub mod failure;
pub mod graphics;
pub mod quietly;
pub mod scale;
pub mod wayland_socket;
pub mod x_server;
