//! The farsa command.
fn main() {}
