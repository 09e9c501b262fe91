// Model files. HDF5 itself is not what is tried here, but what is made of what it reads.
#include <cmath>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {

void model_file(Input input) {
  const std::filesystem::path path = scratch_file("it.h5", text_of(input));
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    try {
      const Model model = read_model(path, kind);
      expect(model.body.mass > 0.0 && std::isfinite(model.body.mass), "a model has a mass");
      expect(model.mesh.nodes.allFinite(), "a model's nodes are somewhere");
    } catch (const Error&) {
    }
  }
}

}  // namespace irdm::fuzz
