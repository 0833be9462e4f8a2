//! Valid lengths, hashes and checksums, as a forger can compute them, so that the content behind them is read.

use farsa_num::{Digest, crc32};

/// Bytes before the parameters of a controller, and of its checksum (docs/controller-format.md).
const CONTROLLER: usize = 72;
const CHECKSUM: usize = 4;
/// Bytes before the content of a file of a run.
const HEAD: usize = 8 + 4 + 8;

fn put(bytes: &mut [u8], at: usize, what: &[u8]) {
    bytes[at..at + what.len()].copy_from_slice(what);
}

fn digest(parts: &[&[u8]]) -> u64 {
    let mut digest = Digest::new();
    parts.iter().for_each(|part| digest.add_bytes(part));
    digest.finish()
}

/// Returns a controller with valid magic bytes, version, lengths, hashes and checksum, or `None` for too few bytes.
pub fn sealed_controller(bytes: &[u8]) -> Option<Vec<u8>> {
    let end = bytes.len().checked_sub(CHECKSUM)?;
    let parameters = end.checked_sub(CONTROLLER)?;
    let mut sealed = bytes.to_vec();
    put(&mut sealed, 0, b"FARSA-NN");
    put(&mut sealed, 8, &1_u32.to_le_bytes());
    let kind = sealed[12] % 8;
    put(&mut sealed, 12, &u32::from(kind).to_le_bytes());
    put(&mut sealed, 16, &u32::try_from(bytes.len()).ok()?.to_le_bytes());
    put(&mut sealed, 20, &u32::try_from(parameters).ok()?.to_le_bytes());
    if kind == 5 {
        // The shape has a hash of the description, which is three words for each group and six for each block.
        let count = |at: usize| usize::from(sealed[at]) + 256 * usize::from(sealed[at + 1]);
        let description = (12 * count(32) + 24 * count(36)).min(parameters);
        let hash = digest(&[&sealed[CONTROLLER..CONTROLLER + description]]);
        put(&mut sealed, 44, &hash.to_le_bytes());
    }
    let hash = digest(&[&sealed[12..16], &sealed[24..56]]);
    put(&mut sealed, 56, &hash.to_le_bytes());
    let checksum = crc32(&sealed[..end]);
    put(&mut sealed, end, &checksum.to_le_bytes());
    Some(sealed)
}

/// Returns a file of a run of the given kind and content.
pub fn sealed_file(kind: &[u8; 8], content: &[u8]) -> Vec<u8> {
    let length = content.len() as u64;
    let mut bytes = [kind.as_slice(), &1_u32.to_le_bytes(), &length.to_le_bytes(), content].concat();
    bytes.extend(crc32(&bytes).to_le_bytes());
    bytes
}

/// Returns the content of a file of a run without head and checksum, or `None` for too few bytes.
pub fn sealed_head(bytes: &[u8]) -> Option<&[u8]> {
    bytes.get(HEAD..bytes.len().checked_sub(CHECKSUM)?)
}
