//! Errors of drawing, in sentences that name the remedy.

/// A picture that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// No graphics driver at all.
    #[error(
        "no graphics driver was found; install one (on Debian and Ubuntu the software driver is the package \
         mesa-vulkan-drivers, together with libvulkan1)"
    )]
    NoDriver,
    /// The driver refused to open its device.
    #[error(
        "the graphics driver \"{adapter}\" could not be opened ({reason}); update the driver or install mesa-vulkan-drivers"
    )]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// A size that no texture can have.
    #[error("a picture of {width} × {height} pixels cannot be drawn; choose 1 to {limit} pixels for each side")]
    Size {
        /// Width asked for, pixels.
        width: u32,
        /// Height asked for, pixels.
        height: u32,
        /// Longest side that the driver can draw, pixels.
        limit: u32,
    },
    /// The picture was drawn but could not be copied back.
    #[error("the picture could not be read back from the graphics driver ({0})")]
    ReadBack(String),
}
