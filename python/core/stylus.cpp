#include <pybind11/stl.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "device_bridge/stylus_client.hpp"
#include "python/core/arrays.hpp"
#include "python/core/module.hpp"

namespace py = pybind11;

namespace irdm::python {
namespace {

std::unique_ptr<StylusClient> connect(const std::string& address, const std::string& options) {
  const StylusSettings settings =
      read_stylus_settings(address, TomlTable::parse_text(options, "options"));
  const py::gil_scoped_release released;
  return std::make_unique<StylusClient>(settings, look_at_signals);
}

py::array_t<double> vector(const Vector3& v) {
  return py::array_t<double>(3, v.data());
}

class PythonStylus {
 public:
  PythonStylus(const std::string& address, const std::string& options)
      : client_(connect(address, options)) {}
  PythonStylus(const PythonStylus&) = delete;
  PythonStylus& operator=(const PythonStylus&) = delete;
  ~PythonStylus() { close(); }

  void set(const py::object& tip, const py::object& orientation, std::uint32_t buttons) {
    if (client().lockstep()) throw std::runtime_error("the run is in lockstep: use step()");
    client().set(pose(tip, orientation, buttons));
  }

  py::array_t<double> step(const py::object& tip, const py::object& orientation,
                           std::uint32_t buttons) {
    if (!client().lockstep()) throw std::runtime_error("not connected in lockstep: use set()");
    const StylusPose at = pose(tip, orientation, buttons);
    if (stepping_) throw std::runtime_error("another thread is in step()");
    stepping_ = true;
    try {
      StylusFeedback feedback;
      {
        const py::gil_scoped_release released;
        feedback = client_->step(at, look_at_signals);
      }
      stepping_ = false;
      return vector(feedback.force);
    } catch (...) {
      stepping_ = false;
      throw;
    }
  }

  void close() {
    if (::getpid() != process_) {
      // Threads of the client are in the parent, and what it signals and sends would reach there:
      // this copy is left as it is.
      [[maybe_unused]] StylusClient* const copy = client_.release();
      return;
    }
    if (stepping_) throw std::runtime_error("another thread is in step()");
    std::unique_ptr<StylusClient> gone = std::move(client_);
    const py::gil_scoped_release released;
    gone.reset();
  }

  bool closed() const { return !client_; }
  StylusClient& client() const {
    if (!client_) throw std::runtime_error("the stylus is closed");
    if (::getpid() == process_) return *client_;
    throw std::runtime_error("the stylus is of the process before fork(): connect another one");
  }
  StylusClient& idle_client() const {
    if (stepping_) throw std::runtime_error("another thread is in step()");
    return client();
  }
  StylusFeedback get() const { return idle_client().get(); }
  std::string state() const { return client_ && !stepping_ ? client().state() : closed_or_busy(); }

 private:
  std::string closed_or_busy() const { return client_ ? "ready: in step()" : "closed"; }

  StylusPose pose(const py::object& tip, const py::object& orientation,
                  std::uint32_t buttons) const {
    StylusPose pose;
    pose.tip = Vector3(numbers(tip, "tip", {{3}}).data());
    if (!orientation.is_none()) {
      const auto given = numbers(orientation, "orientation", {{4}});
      const double* q = given.data();
      pose.orientation = Quaternion(q[0], q[1], q[2], q[3]);
    }
    pose.buttons = buttons;
    if (const char* const fault = client().fault_of(pose)) throw py::value_error(fault);
    return pose;
  }

  std::unique_ptr<StylusClient> client_;  ///< null: closed
  bool stepping_ = false;                 ///< all under the interpreter's lock
  pid_t process_ = ::getpid();            ///< that has connected
};

}  // namespace

void bind_stylus(py::module_& module) {
  using Self = PythonStylus;
  py::class_<Self>(module, "StylusCore")
      .def(py::init<const std::string&, const std::string&>(), py::arg("address"),
           py::arg("options"))
      .def("set", &Self::set, py::arg("tip"), py::arg("orientation") = py::none(),
           py::arg("buttons") = 0, R"(Real time: where the stylus is from now on.

tip: (3) [m], within 2 m of the origin of its frame, which is W without a `workspace`. orientation: (4) w x y z, of length
1; None: not turned. buttons: irdm.GRAB | irdm.RESET. Raises ValueError or TypeError, and then nothing has changed.)")
      .def("step", &Self::step, py::arg("tip"), py::arg("orientation") = py::none(),
           py::arg("buttons") = 0,
           R"(Lockstep: the server's next step, at whose end the tip is there.

tip: (3) [m], W, within 1000 m; the rest as of set(). Returns the force on the stylus, (3) [N], W. Other threads go on
meanwhile. Raises ValueError, and irdm.Error when the run is over; Ctrl-C ends the connection.)")
      .def("close", &Self::close,
           "Lets the force fade and says goodbye; in up to half a second. In a child of os.fork() "
           "only the child's copy is closed.")
      .def_property_readonly("closed", &Self::closed)
      .def_property_readonly(
          "force", [](const Self& self) { return vector(self.get().force); },
          "(3) on the stylus [N]: in real time as shown by the safety filter, in the frame of the "
          "tips; in lockstep the server's of the last step, W. Zero where it is older than 50 ms.")
      .def_property_readonly(
          "torque", [](const Self& self) { return vector(self.get().torque); },
          "(3) on the stylus about its tip [N m], as force.")
      .def_property_readonly(
          "contact", [](const Self& self) { return static_cast<int>(self.get().contact); },
          "0 free, 1 touching, 2 held.")
      .def_property_readonly(
          "ready", [](const Self& self) { return self.get().ready; },
          "Linked, armed, and tips are set.")
      .def_property_readonly("state", &Self::state,
                             "What it is at, and why there is no force, in a line.")
      .def_property_readonly(
          "latency", [](const Self& self) { return self.get().latency; },
          "Age of the tip that the force answers [s]; nan: no force yet.")
      .def_property_readonly(
          "ticks", [](const Self& self) { return self.get().ticks; },
          "Of the thread below so far; in lockstep: steps.")
      .def_property_readonly(
          "late_ticks", [](const Self& self) { return self.get().late_ticks; },
          "Ticks that were left out, as the thread was late by more than a period.")
      .def_property_readonly(
          "sessions", [](const Self& self) { return self.get().sessions; },
          "With a server, so far.")
      .def_property_readonly(
          "time",
          [](const Self& self) { return kNanosecond * static_cast<double>(self.get().time_ns); },
          "Of the newest tick, of time.monotonic(); in lockstep of the step [s].")
      .def_property_readonly(
          "dt", [](const Self& self) { return self.idle_client().dt(); },
          "Force step of the server [s].")
      .def_property_readonly(
          "number", [](const Self& self) { return self.idle_client().number(); }, "In the scene.")
      .def_property_readonly("lockstep", [](const Self& self) { return self.client().lockstep(); });
}

}  // namespace irdm::python
