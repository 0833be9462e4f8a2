//! Origin of a request, and headers of an answer.

use hyper::header::{
    CACHE_CONTROL, CONTENT_TYPE, HOST, HeaderMap, HeaderName, HeaderValue, ORIGIN, X_CONTENT_TYPE_OPTIONS,
    X_FRAME_OPTIONS,
};
use hyper::{Response, StatusCode, Uri};

use crate::live::http::answer::Answer;

/// Checks if a request names this address and comes from its own page or from no page.
///
/// Images of external pages are requested without an origin, but with `Sec-Fetch-Site`. External pages may link to the page,
/// but not to the events, which would stay open as long as the window.
pub(in crate::live) fn is_same_origin(headers: &HeaderMap, uri: &Uri, port: u16) -> bool {
    // Browsers omit the default port.
    let is_here = |host: &str| {
        ["127.0.0.1", "localhost"].into_iter().any(|name| match host.strip_prefix(name) {
            Some("") => port == 80,
            Some(rest) => rest.strip_prefix(':') == Some(&port.to_string()),
            None => false,
        })
    };
    let mut hosts = headers.get_all(HOST).iter().map(|host| host.to_str().unwrap_or_default());
    let (Some(host), None) = (hosts.next(), hosts.next()) else { return false };
    let header = |name: &str| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    let from_here = |origin: &str| origin.strip_prefix("http://") == Some(host);
    let is_same_site = |site| site == "same-origin" || site == "none";
    let is_linked = uri.path() == "/" && header("sec-fetch-dest") == Some("document");
    let is_allowed = is_linked || header("sec-fetch-site").is_none_or(is_same_site);
    // A request to a proxy has the address in its first line.
    let is_direct = uri.authority().is_none_or(|authority| is_here(authority.as_str()));
    is_here(host) && is_direct && header(ORIGIN.as_str()).is_none_or(from_here) && is_allowed
}

/// Returns the value of a parameter of an address.
pub(in crate::live) fn parameter<'q>(query: &'q str, name: &str) -> Option<&'q str> {
    query.split('&').find_map(|pair| pair.strip_prefix(name)?.strip_prefix('='))
}

/// Builds an answer, which no other site may show or keep.
pub(in crate::live) fn response(status: u16, kind: &'static str, body: Answer) -> Response<Answer> {
    let mut response = Response::new(body);
    *response.status_mut() = StatusCode::from_u16(status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let policy = HeaderName::from_static("cross-origin-resource-policy");
    for (name, value) in [
        (CONTENT_TYPE, kind),
        (CACHE_CONTROL, "no-store"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (policy, "same-origin"),
    ] {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_here() {
        let same = |port: u16, uri: &str, host: &str| {
            let headers = HeaderMap::from_iter([(HOST, HeaderValue::from_str(host).unwrap())]);
            is_same_origin(&headers, &uri.parse().unwrap(), port)
        };
        assert!(same(8377, "/", "127.0.0.1:8377") && same(8377, "http://localhost:8377/", "localhost:8377"));
        assert!(same(80, "/", "127.0.0.1") && same(80, "/", "localhost"));
        for (uri, host) in [
            ("/", "127.0.0.1"),
            ("/", "127.0.0.1:83770"),
            ("/", "127.0.0.1.example.org:8377"),
            ("/", "localhost:8378"),
            ("/", ""),
            ("http://example.org/", "127.0.0.1:8377"),
        ] {
            assert!(!same(8377, uri, host), "{uri} {host}");
        }
        assert_eq!((parameter("run=a&from=3", "from"), parameter("fromage=3", "from")), (Some("3"), None));
    }
}
