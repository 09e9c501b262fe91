#include "common/model/model_units.hpp"

#include <string>

#include "common/model/compressed_file.hpp"
#include "common/model/model_writer.hpp"
#include "common/model/residual_file.hpp"

namespace irdm {
namespace {

struct Unit {
  const char* object;
  const char* unit;
};

// What has none, or says it already, is not here.
constexpr Unit kDatasetUnits[] = {
    {"/mesh/nodes", "m"},
    {"/mesh/node_mass", "kg"},
    {"/response/modal/angular_frequency", "rad/s"},
    {"/response/modal/decay_rate", "1/s"},
    {"/response/modal/shapes", "kg^-1/2"},
    {kResidualBlocks, "m/N"},
    {kModalGravity, "kg^1/2"},
    {kModalGravityRest, "s^2"},
    {kDenseGravity, "s^2"},
    {kDenseR, "m/N"},
    {kCompressedEarlyScale, "m/N"},
    {kCompressedShapes, "1"},
    {kCompressedPole, "1"},
    {kCompressedAmplitude, "m/N"},
};

constexpr Unit kGroupUnits[] = {
    {"/mesh", "com_offset: m"},
    {"/body", "mass: kg, inertia: kg m^2"},
    {"/material",
     "youngs_modulus: Pa, poisson_ratio: 1, density: kg/m^3, rayleigh_alpha: 1/s, "
     "rayleigh_beta: s"},
    {"/response", "dt: s"},
    {kModalResidual,
     "cut_off: rad/s, contact_radius: m, residual_radius: m, press_time: s, added_compliance: m/N"},
};

}  // namespace

void write_model_units(hdf5::File& file) {
  const auto write = [&](const char* object, const char* name, const char* unit) {
    if (file.exists(object)) file.write_attribute(object, name, std::string(unit));
  };
  for (const auto& [object, unit] : kDatasetUnits) write(object, "unit", unit);
  for (const auto& [object, unit] : kGroupUnits) write(object, "units", unit);
  write(kCompressedEarly, "unit", file.exists(kCompressedEarlyScale) ? "1" : "m/N");
}

}  // namespace irdm
