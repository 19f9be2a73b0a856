pub(crate) mod block_world;
pub(crate) mod hypothetical_worlds;
pub(crate) mod model;
pub(crate) mod needle_world;
pub(crate) mod switch_world;
pub(crate) mod world;
