#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace irdm {

/// A kind of secret that is kept in a file.
struct SecretKind {
  const char* name;  ///< as messages call it, "key" say
  int bytes;         ///< of `openssl rand -hex`, which makes one
};

/// Reads the file of a secret, which must be a regular file of this user or of root that nobody
/// else may read or write. It is opened once, and what was opened is judged. A file in the folder
/// that systemd names in $CREDENTIALS_DIRECTORY may have the permission to read for its group,
/// which stands for the access list of the service's user there (systemd 254 and later); folder
/// and file must then belong to this user or to root, and others must have no access to them.
/// Returns the content, of at most 4096 bytes, without white space around it. Throws Error, which
/// never quotes the content.
std::string read_secret_file(const std::filesystem::path& path, const SecretKind& kind);

/// Whether a text can be a viewer's token: 16 to 128 printable ASCII characters without blanks.
bool is_token(std::string_view text);

/// Reads the file of a viewer's token. Throws Error as read_secret_file() does.
std::string read_token_file(const std::filesystem::path& path);

}  // namespace irdm
