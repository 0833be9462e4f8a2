//! Initial camera of a page.

/// Initial camera of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum View {
    /// Looks from a side, and can be rotated.
    #[default]
    Free,
    /// Looks from above. This is useful for planar arenas.
    Top,
}
