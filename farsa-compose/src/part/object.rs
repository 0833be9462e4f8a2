//! Parts of unknown types, in all worlds.

use std::any::Any;
use std::fmt;

use farsa_body::ports::{Motor, Sensor};
use farsa_physics::{arena, articulated};

use crate::part::end::End;
use crate::part::start::Start;
use crate::part::term::Term;

/// Abilities in the worlds of rapier, which exist only with the feature `rapier`.
mod in_rapier {
    #[cfg(feature = "rapier")]
    use super::{End, Motor, Sensor, Start, Term};

    macro_rules! in_rapier {
        ($name:ident, $port:ident, $world:ident) => {
            #[cfg(feature = "rapier")]
            pub trait $name: $port<farsa_physics::rapier::$world> {}
            #[cfg(feature = "rapier")]
            impl<T: $port<farsa_physics::rapier::$world> + ?Sized> $name for T {}
            #[cfg(not(feature = "rapier"))]
            pub trait $name {}
            #[cfg(not(feature = "rapier"))]
            impl<T: ?Sized> $name for T {}
        };
    }
    in_rapier!(PlanarSensor, Sensor, ArenaWorld);
    in_rapier!(PlanarMotor, Motor, ArenaWorld);
    in_rapier!(PlanarTerm, Term, ArenaWorld);
    in_rapier!(PlanarStart, Start, ArenaWorld);
    in_rapier!(PlanarEnd, End, ArenaWorld);
    in_rapier!(SpatialSensor, Sensor, World);
    in_rapier!(SpatialMotor, Motor, World);
    in_rapier!(SpatialTerm, Term, World);
    in_rapier!(SpatialStart, Start, World);
    in_rapier!(SpatialEnd, End, World);
}

/// Declares a trait of types with a port in the worlds of an engine, alone and in lanes.
macro_rules! object {
    ($(#[$doc:meta])* $name:ident, $port:ident, $world:ty, $lane:ident) => {
        $(#[$doc])*
        #[diagnostic::on_unimplemented(
            message = "`{Self}` is no part for these worlds",
            note = "it needs `Clone`, `Send` and the port for each world: write `impl<W: Kinematics + ..> ..<W> for ..`"
        )]
        pub trait $name: $port<$world> + for<'a> $port<$lane::Lane<'a>> + in_rapier::$name + Send {
            /// Clones the part.
            #[doc(hidden)]
            fn boxed(&self) -> Box<dyn $name>;
            /// Gets the part with its type.
            #[doc(hidden)]
            fn as_any(&self) -> &dyn Any;
            /// Gets the part with its type.
            #[doc(hidden)]
            fn as_any_mut(&mut self) -> &mut dyn Any;
        }

        impl<T> $name for T
        where
            T: $port<$world> + for<'a> $port<$lane::Lane<'a>> + in_rapier::$name + Clone + Send + 'static,
        {
            fn boxed(&self) -> Box<dyn $name> {
                Box::new(self.clone())
            }

            fn as_any(&self) -> &dyn Any {
                self
            }

            fn as_any_mut(&mut self) -> &mut dyn Any {
                self
            }
        }

        impl Clone for Box<dyn $name> {
            fn clone(&self) -> Self {
                (**self).boxed()
            }
        }

        impl fmt::Debug for dyn $name {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str(stringify!($name))
            }
        }
    };
}

object! {
    /// A sensor for robots on wheels.
    PlanarSensor, Sensor, arena::World, arena
}
object! {
    /// A motor for robots on wheels.
    PlanarMotor, Motor, arena::World, arena
}
object! {
    /// A term for robots on wheels.
    PlanarTerm, Term, arena::World, arena
}
object! {
    /// A placement for robots on wheels.
    PlanarStart, Start, arena::World, arena
}
object! {
    /// An end of a trial for robots on wheels.
    PlanarEnd, End, arena::World, arena
}
object! {
    /// A sensor for robots with joints.
    SpatialSensor, Sensor, articulated::World<f32>, articulated
}
object! {
    /// A motor for robots with joints.
    SpatialMotor, Motor, articulated::World<f32>, articulated
}
object! {
    /// A term for robots with joints.
    SpatialTerm, Term, articulated::World<f32>, articulated
}
object! {
    /// A placement for robots with joints.
    SpatialStart, Start, articulated::World<f32>, articulated
}
object! {
    /// An end of a trial for robots with joints.
    SpatialEnd, End, articulated::World<f32>, articulated
}
