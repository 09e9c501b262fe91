#include "python/core/module.hpp"

#include <pybind11/stl.h>

#include "common/error.hpp"
#include "python/core/arrays.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of irdm.";
  module.attr("__version__") = IRDM_VERSION;
  py::register_exception<irdm::Error>(module, "Error", PyExc_ValueError).doc() =
      "Bad input or a failure that a person has to do something about: where, what, and what to "
      "do.";
  module.def(
      "numbers",
      [](const py::object& given, const std::string& name, const irdm::python::Shape& shape) {
        return irdm::python::numbers(given, name.c_str(), {shape});
      },
      "A checked array of real numbers of this shape. Raises TypeError, ValueError.");
  irdm::python::bind_model(module);
  irdm::python::bind_simulation(module);
  irdm::python::bind_stylus(module);
}
