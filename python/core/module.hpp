#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "common/geometry.hpp"

/// The compiled part of the Python package `irdm`. What users see is described in irdm/_core.pyi
/// and docs/python.md.
namespace irdm::python {

void bind_model(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_stylus(pybind11::module_& module);

/// While the interpreter is free: lets Ctrl-C through.
inline void look_at_signals() {
  const pybind11::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

/// A view of numbers that `owner` keeps alive, which cannot be written to.
template <typename Number>
pybind11::array view(std::vector<pybind11::ssize_t> shape, const Number* numbers,
                     const pybind11::handle& owner) {
  pybind11::array_t<Number> array(std::move(shape), numbers, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A copy of rows of numbers, all of one width.
template <typename Matrix>
pybind11::array copy(const Matrix& matrix) {
  using Rows =
      Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  pybind11::array_t<typename Matrix::Scalar> array({matrix.rows(), matrix.cols()});
  Eigen::Map<Rows>(array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
  return array;
}

}  // namespace irdm::python
