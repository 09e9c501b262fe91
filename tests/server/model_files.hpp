#pragma once

#include <filesystem>

#include "common/model/model_file.hpp"
#include "common/model/model_writer.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::test {

/// Writes the model file of a small modal cube.
inline void write_cube_model(const std::filesystem::path& path,
                             Support support = Support::kFloating) {
  Model cube = synthetic_cube(2, 3, 4);
  cube.body.support = support;
  ModelFileWriter writer(path);
  writer.write_description(cube);
  writer.write_modal(std::get<ModalResponse>(cube.response));
  writer.commit();
}

}  // namespace irdm::test
