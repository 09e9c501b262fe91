#pragma once

#include <memory>
#include <utility>

#include "common/model/model.hpp"

namespace irdm::test {

inline std::shared_ptr<const Model> share(Model model) {
  return std::make_shared<const Model>(std::move(model));
}

}  // namespace irdm::test
