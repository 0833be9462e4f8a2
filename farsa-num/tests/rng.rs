//! The stream as a generator of the `rand` ecosystem.
#![cfg(feature = "rand_core")]

use farsa_num::{Domain, Stream};
use rand_core::{Rng, SeedableRng};

/// Draws as other code does.
fn draw(rng: &mut impl Rng) -> (u32, u64) {
    (rng.next_u32(), rng.next_u64())
}

#[test]
fn words_are_those_of_the_stream() {
    let mut stream = Stream::new(5, Domain::Network, 0, 1, 2);
    let mut same = stream;
    for _ in 0..9 {
        assert_eq!(draw(&mut same), (stream.next_u32(), stream.next_u64()));
    }
}

#[test]
fn bytes_are_words_in_little_endian() {
    for len in 0..23 {
        let mut stream = Stream::from_seed(11);
        let mut same = stream;
        let mut bytes = vec![0; len];
        same.fill_bytes(&mut bytes);
        let words: Vec<u8> = (0..len.div_ceil(4)).flat_map(|_| stream.next_u32().to_le_bytes()).collect();
        assert_eq!(bytes, words[..len]);
        assert_eq!(same.position(), stream.position());
    }
}

#[test]
fn every_seed_is_that_of_the_stream() {
    let stream = Stream::from_seed(0x0123_4567_89AB_CDEF);
    let seed = [0xEF, 0xCD, 0xAB, 0x89, 0x67, 0x45, 0x23, 0x01];
    assert_eq!(<Stream as SeedableRng>::from_seed(seed), stream);
    assert_eq!(Stream::seed_from_u64(0x0123_4567_89AB_CDEF), stream);
}
