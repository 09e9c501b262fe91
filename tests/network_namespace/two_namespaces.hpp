#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace irdm::test {

/// Two network namespaces without a name, each with a TUN device and nothing else, so that what
/// goes from one to the other comes out at the descriptors here. The kernel takes them away with
/// the last process that has them open, however that ends.
class TwoNamespaces {
 public:
  /// Throws Error where the kernel does not let this process make them, and says why.
  TwoNamespaces();
  TwoNamespaces(const TwoNamespaces&) = delete;
  TwoNamespaces& operator=(const TwoNamespaces&) = delete;
  ~TwoNamespaces();

  /// The IP address in a namespace, 0 or 1.
  static std::string address(std::size_t which);
  std::array<int, 2> devices() const noexcept { return devices_; }
  /// A command that runs in that namespace, and is killed when the calling thread ends.
  std::vector<std::string> inside(std::size_t which, const std::vector<std::string>& command) const;
  /// Takes the calling thread there, and threads that it starts from then on. Throws Error.
  void enter(std::size_t which) const;

 private:
  void make(std::size_t which);

  std::array<int, 2> namespaces_{-1, -1};
  std::array<int, 2> devices_{-1, -1};
};

}  // namespace irdm::test
