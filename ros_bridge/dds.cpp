#include "ros_bridge/dds.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>

#include "common/error.hpp"

namespace irdm::ros {
namespace {

// What a dds_create_... returned, unless it is an error code.
dds_entity_t made(dds_entity_t handle, const std::string& what) {
  if (handle >= 0) return handle;
  throw Error("DDS", "no " + what + ": " + dds_strretcode(handle),
              "check --domain and the network interfaces (CYCLONEDDS_URI)");
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos quality(bool reliable, int depth) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  constexpr dds_duration_t kLongestBlock = DDS_MSECS(100);
  const auto reliability = reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT;
  dds_qset_reliability(qos.get(), reliability, kLongestBlock);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

// Nodes on this machine are found by their ports, one after the other, without multicast.
constexpr const char* kLoopbackOnly =
    "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery>";

// Whether a descriptor is a UDP socket that takes datagrams of every interface.
bool is_open_udp(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) {
    return false;
  }
  sockaddr_in address{};
  size = sizeof address;
  return ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && address.sin_addr.s_addr == htonl(INADDR_ANY);
}

// Cyclone DDS receives on all interfaces, whichever it is to use (0.10.2): a peer in the network
// that sends to its ports would be heard. So each of its sockets is bound to the loopback
// interface; there are no readers yet.
void bind_to_loopback() {
  constexpr char kInterface[] = "lo";
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename().string());
    if (!is_open_udp(descriptor)) continue;
    if (::setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kInterface, sizeof kInterface) != 0) {
      throw Error("DDS",
                  "its sockets cannot be bound to the loopback interface: " +
                      std::generic_category().message(errno),
                  "use Linux 5.7 or later, or --network where everyone may send commands");
    }
  }
}

}  // namespace

Participant::Participant(std::uint32_t domain, const std::string& name_space, Reach reach)
    : domain_(reach == Reach::kThisMachine
                  ? made(dds_create_domain(domain, kLoopbackOnly), "domain")
                  : 0),
      handle_(made(dds_create_participant(domain, nullptr, nullptr), "participant")),
      name_space_(name_space) {
  if (reach == Reach::kThisMachine) bind_to_loopback();
}

Participant::~Participant() {
  dds_delete(handle_);
  if (domain_ > 0) dds_delete(domain_);
}

dds_entity_t Participant::topic(const dds_topic_descriptor_t& type, const std::string& name) const {
  const std::string mangled = "rt" + full_name(name);
  return made(dds_create_topic(handle_, &type, mangled.c_str(), nullptr, nullptr),
              "topic " + mangled);
}

Endpoint Participant::writer(const dds_topic_descriptor_t& type, const std::string& name) const {
  const Qos qos = quality(true, 10);
  return Endpoint(made(dds_create_writer(handle_, topic(type, name), qos.get(), nullptr),
                       "writer of " + full_name(name)));
}

Endpoint Participant::reader(const dds_topic_descriptor_t& type, const std::string& name,
                             bool reliable) const {
  const Qos qos = quality(reliable, 1);
  return Endpoint(made(dds_create_reader(handle_, topic(type, name), qos.get(), nullptr),
                       "reader of " + full_name(name)));
}

}  // namespace irdm::ros
