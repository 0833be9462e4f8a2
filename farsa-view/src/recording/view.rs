//! The initial camera of a page.

/// The initial camera of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum View {
    /// From a side, rotatable.
    #[default]
    Free,
    /// From above, for planar arenas.
    Top,
}
