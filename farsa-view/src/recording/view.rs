//! From where a page first looks.

/// How a page looks at the bodies at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum View {
    /// From a side, to be turned.
    #[default]
    Free,
    /// From above: planar arenas.
    Top,
}
