//! Secret of the address, without which no request is answered.

use hyper::header::{COOKIE, HeaderMap};

use crate::error::Error;

/// Header by which programs send the token.
const HEADER: &str = "x-farsa-token";
/// Bytes of a token.
const BYTES: usize = 16;

/// 128 random bits of the operating system, as 32 hexadecimal digits.
#[derive(Debug, Clone)]
pub(super) struct Token(String);

impl Token {
    /// Takes random bits of the operating system.
    ///
    /// # Errors
    /// [`Error::Other`] where the system has none.
    pub(super) fn new() -> Result<Self, Error> {
        let mut bytes = [0; BYTES];
        getrandom::fill(&mut bytes).map_err(|error| Error::Other(format!("no random numbers: {error}")))?;
        Ok(Self(format!("{:032x}", u128::from_be_bytes(bytes))))
    }

    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Compares a text in a time that does not depend on its bytes.
    pub(super) fn is(&self, text: &str) -> bool {
        let differing = self.0.bytes().zip(text.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b));
        text.len() == self.0.len() && differing == 0
    }

    /// Returns the name of the cookie. Servers on other ports of this machine receive it, too, and have their own.
    fn cookie_name(port: u16) -> String {
        format!("farsa-lab-{port}")
    }

    /// Formats the cookie, which no script reads and no other site sends.
    pub(super) fn cookie(&self, port: u16) -> String {
        format!("{}={}; Path=/; HttpOnly; SameSite=Strict", Self::cookie_name(port), self.0)
    }

    /// Checks if a request has the token, as a cookie or as a header.
    pub(super) fn is_in(&self, headers: &HeaderMap, port: u16) -> bool {
        let name = Self::cookie_name(port);
        let cookies = headers.get_all(COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = cookies.flat_map(|text| text.split(';')).filter_map(|pair| pair.trim().split_once('='));
        let header = headers.get(HEADER).and_then(|value| value.to_str().ok());
        header.is_some_and(|text| self.is(text)) || pairs.any(|(key, value)| key == name && self.is(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyper::header::{HeaderName, HeaderValue};

    #[test]
    fn tokens_differ_and_only_the_same_one_is_accepted() {
        let (token, other) = (Token::new().unwrap(), Token::new().unwrap());
        assert_eq!(token.text().len(), 32);
        assert!(token.is(token.text()) && !token.is(other.text()));
        for wrong in ["", &token.text()[1..], &format!("{}0", token.text()), &token.text().replace(|_: char| true, "g")]
        {
            assert!(!token.is(wrong), "{wrong}");
        }
        let headers = |name: &'static str, value: String| {
            HeaderMap::from_iter([(HeaderName::from_static(name), HeaderValue::from_str(&value).unwrap())])
        };
        let text = token.text();
        assert!(token.is_in(&headers("cookie", format!("a=b; farsa-lab-80={text}")), 80));
        assert!(token.is_in(&headers("x-farsa-token", text.into()), 80));
        assert!(!token.is_in(&headers("cookie", format!("farsa-lab-81={text}")), 80));
        assert!(!token.is_in(&headers("cookie", format!("farsa-lab-80={}", other.text())), 80));
        assert!(!token.is_in(&HeaderMap::new(), 80));
    }
}
