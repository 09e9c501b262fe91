#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

struct evp_md_ctx_st;

namespace irdm {

/// SHA-256 of bytes that come in pieces.
class Sha256 {
 public:
  Sha256();
  void update(const void* bytes, std::size_t count);
  /// Of all bytes so far, in lower-case hexadecimal; called once, at the end.
  std::string hexadecimal();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// SHA-256 of a file's bytes in lower-case hexadecimal, as the program sha256sum prints it. Throws
/// Error.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace irdm
