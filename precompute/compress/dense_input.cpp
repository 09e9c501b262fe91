#include "precompute/compress/dense_input.hpp"

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_file.hpp"

namespace irdm::precompute {

DenseInput::DenseInput(const std::filesystem::path& path)
    : file_(hdf5::File::open(path)), model_(read_description(hdf5::File::open(path))) {
  if (is_rigid(model_)) {
    throw Error(name(), "is of a rigid body, which has no response to compress",
                "use it as it is, with any engine");
  }
  if (!file_.exists(kDenseR)) {
    throw Error(name(), "has no dense response to compress",
                "precompute with storage = \"dense\" or \"both\"");
  }
  require_content_checksum(file_);
  R_ = stored_response(path, degrees_of_freedom(), steps());
}

double DenseInput::bytes() const {
  const double dof = degrees_of_freedom();
  return dof * dof * steps() * static_cast<double>(file_.element_size(kDenseR));
}

RowMatrix<float> DenseInput::column(int b) const {
  const RowMatrix<float> values = R_->column(b, steps()).cast<float>();
  if (!values.allFinite() ||
      values.cwiseAbs().maxCoeff() > static_cast<float>(lab::kCompliance.highest)) {
    throw Error(name(), "/response/dense/R has numbers that are not finite or out of range",
                "make the model again with irdm-precompute");
  }
  return values;
}

}  // namespace irdm::precompute
