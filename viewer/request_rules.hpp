#pragma once

#include <string_view>

/// Who may open a WebSocket (docs/viewer-protocol.md). Pure.
namespace irdm::viewer {

/// Whether a page of this Origin may talk to the server that it calls Host. Without a token the
/// host must be a numeric address or localhost besides, so that no name that an attacker points to
/// this machine gets in.
bool origin_allowed(std::string_view origin, std::string_view host, bool token_needed);

/// Compares in a time that does not depend on where the two differ.
bool same_token(std::string_view given, std::string_view wanted);

/// Whether a list of codings as in Accept-Encoding has gzip in it, and not with q=0.
bool accepts_gzip(std::string_view codings);

/// Whether a list as in If-None-Match names this entity tag.
bool names_etag(std::string_view list, std::string_view etag);

}  // namespace irdm::viewer
