#include "python/core/module.hpp"

#include "common/error.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of irdm.";
  module.attr("__version__") = IRDM_VERSION;
  py::register_exception<irdm::Error>(module, "Error", PyExc_ValueError).doc() =
      "Bad input or a failure that a person has to do something about: where, what, and what to "
      "do.";
  irdm::python::bind_model(module);
  irdm::python::bind_simulation(module);
  irdm::python::bind_stylus(module);
}
