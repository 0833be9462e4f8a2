//! Saving and reading what describes a network: the same comes back, under the names of configurations.
#![cfg(all(feature = "serde", feature = "alloc"))]

use std::fmt::Debug;

use farsa_nn::block::{Architecture, Block, BlockLayoutBuf, BlockParameter, EvonetRanges, Span};
use farsa_nn::learning::{Adam, Loss, Momentum};
use farsa_nn::quantized::QuantizedScale;
use farsa_nn::{Activation, CtrnnLayout, CtrnnParameter, Integrator, Leak, LeakyLayout, LeakyParameter, Lesion};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::{from_str, to_string};

/// Saves and reads a value. Returns the saved text.
#[expect(clippy::needless_pass_by_value, reason = "so that it maps arrays")]
fn comes_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: T) -> String {
    let saved = to_string(&value).expect("plain data");
    assert_eq!(from_str::<T>(&saved).expect("as it was saved"), value, "{saved}");
    saved
}

#[test]
fn names_are_those_of_configurations() {
    for activation in Activation::ALL {
        assert_eq!(comes_back(activation), format!("\"{activation}\""));
    }
    for integrator in Integrator::ALL {
        assert_eq!(comes_back(integrator), format!("\"{integrator}\""));
    }
    for leak in Leak::ALL {
        assert_eq!(comes_back(leak), format!("\"{leak}\""));
    }
    assert_eq!([Loss::SquaredError, Loss::CrossEntropy].map(comes_back), ["\"squared-error\"", "\"cross-entropy\""]);
    assert_eq!(comes_back(LeakyParameter::SensorWeight), "\"sensor-weight\"");
    assert_eq!(comes_back(CtrnnParameter::TimeConstant), "\"time-constant\"");
    assert_eq!(comes_back(BlockParameter::Gain), "\"gain\"");
    assert!(from_str::<Leak>("\"filters\"").is_err());
}

#[test]
fn layouts_and_options_come_back() {
    let saved = comes_back(LeakyLayout::new(29, 12, 23).with_slope(0.2));
    assert_eq!(saved, r#"{"sensors":29,"hidden":12,"outputs":23,"slope":0.2}"#);
    comes_back(CtrnnLayout::new(2, 5, 2).with_integrator(Integrator::RungeKutta4));
    let architecture = Architecture::elman(3, 4, 2).with_leaks().with_input_delay(2);
    comes_back(architecture);
    let layout = BlockLayoutBuf::from(architecture.plan().layout());
    let saved = comes_back(layout.clone());
    assert_eq!(from_str::<BlockLayoutBuf>(&saved).expect("saved").layout(), architecture.plan().layout());
    assert_eq!(comes_back(Block::Update(Span::new(3, 4))), r#"{"update":{"first":3,"count":4}}"#);
    comes_back(Block::ModulatedGain { neurons: Span::new(1, 2), by: 5 });
    comes_back(EvonetRanges::default());
    comes_back(Lesion::new(3));
    comes_back(Adam::new(0.03));
    comes_back(Momentum { rate: 0.5, momentum: 0.9 });
}

#[test]
fn a_scale_is_checked_when_it_is_read() {
    let saved = comes_back(QuantizedScale::new(9, 12, 15).expect("a scale"));
    assert_eq!(saved, r#"{"inputs":9,"weights":12,"sums":15}"#);
    let error = from_str::<QuantizedScale>(&saved.replace(":9", ":16")).expect_err("too many bits").to_string();
    assert!(error.contains("16 fraction bits of inputs: outside [0, 15]"), "{error}");
}
