#include "trace/body_contact_rows.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "common/error.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/step/object_sampling.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"

namespace irdm::trace {
namespace {

constexpr Range kArea{0.0, 1e15, false};  // [m^2]

/// How many samples objects have: those of one model the same number.
class SampleCounts {
 public:
  explicit SampleCounts(const SimulationConfig& config) : config_(config) {}

  int of(std::size_t object) {
    const Model* const model = config_.objects[object].model.get();
    const auto [found, fresh] = counts_.try_emplace(model, 0);
    if (fresh) {
      const RestSurface surface(model->mesh);
      found->second = make_sampling(config_, *model, surface)->sample_count();
    }
    return found->second;
  }

 private:
  const SimulationConfig& config_;
  std::map<const Model*, int> counts_;
};

bool within(int value, Eigen::Index count) {
  return value >= 0 && value < count;
}

// Everything that is an index.
void check_place(const BodyContactRecord& contact, const SimulationConfig& config,
                 SampleCounts& samples, const std::string& file) {
  const auto objects = static_cast<int>(config.objects.size());
  const int ball = stylus_of_ball(config, contact.other);
  bool may = contact.other == contact.object ? config.self_contact : touches_others(config);
  if (ball >= 0) {
    may = within(ball, static_cast<Eigen::Index>(config.styluses.size())) &&
          config.styluses[static_cast<std::size_t>(ball)].has_ball();
  }
  if (!may || !within(contact.object, objects) || contact.other >= objects) {
    throw Error(file, "/body_contact has a contact of bodies that the scene does not have",
                "use the scene that it was recorded with");
  }
  bool good = within(contact.sample, samples.of(static_cast<std::size_t>(contact.object)));
  if (contact.other >= 0) {
    const ModelMesh& mesh = config.objects[static_cast<std::size_t>(contact.other)].model->mesh;
    good = good && within(contact.triangle, mesh.triangles.rows());
  }
  if (good) return;
  throw Error(file, "/body_contact has a sample or a triangle that the model does not have",
              "use the scene and the model that it was recorded with");
}

}  // namespace

BodyContactRows read_body_contacts(const hdf5::File& file, const SimulationConfig& config,
                                   std::uint64_t last_step) {
  BodyContactRows rows;
  const std::string group = kBodyContact;
  if (!file.exists(group + "/force_step")) return rows;
  const EventReader reader(file, group,
                           {"/force_step", "/object", "/other", "/sample", "/slipping", "/triangle",
                            "/weights", "/force", "/position", "/normal", "/slip", "/area"},
                           last_step);
  rows.force_step = reader.force_step();
  const std::size_t count = rows.force_step.size();
  const auto object = reader.read<std::int32_t>("/object");
  const auto other = reader.read<std::int32_t>("/other");
  const auto sample = reader.read<std::int32_t>("/sample");
  const auto slipping = reader.read<std::uint8_t>("/slipping");
  const auto triangle = reader.read<std::int32_t>("/triangle");
  const auto weights = reader.read<double>("/weights", 3);
  const auto force = reader.read<double>("/force", 3);
  const auto position = reader.read<double>("/position", 3);
  const auto normal = reader.read<double>("/normal", 3);
  const auto slip = reader.read<double>("/slip", 3);
  const auto area = reader.read<double>("/area");
  const TraceCheck check(file.name(), rows.force_step);
  check.numbers(group + "/force", force, 3);
  check.numbers(group + "/position", position, 3);
  check.directions(group + "/normal", normal);
  check.numbers(group + "/slip", slip, 3);
  check.numbers(group + "/area", area, 1, kArea);
  check.flags(group + "/slipping", slipping);
  SampleCounts samples(config);
  rows.contact.reserve(count);
  for (std::size_t e = 0; e < count; ++e) {
    BodyContactRecord& contact = rows.contact.emplace_back();
    contact.object = object[e];
    contact.other = other[e];
    contact.sample = sample[e];
    contact.slipping = slipping[e] != 0;
    contact.triangle = triangle[e];
    std::copy_n(weights.begin() + static_cast<std::ptrdiff_t>(3 * e), 3, contact.weights.begin());
    contact.force = vector_of(force, e);
    contact.position = vector_of(position, e);
    contact.normal = vector_of(normal, e);
    contact.slip = vector_of(slip, e);
    contact.area = area[e];
    check_place(contact, config, samples, file.name());
    if (contact.other >= 0) check.weights(group + "/weights", weights, e);
  }
  return rows;
}

}  // namespace irdm::trace
