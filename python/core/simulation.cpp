#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "common/error.hpp"
#include "python/core/arrays.hpp"
#include "python/core/model.hpp"
#include "python/core/module.hpp"
#include "scene/scene_run.hpp"
#include "simulation/step/step_rows.hpp"

namespace py = pybind11;

namespace irdm::python {
namespace {

// What a caller gives for one or many steps: rows of all styluses, step after step.
struct Given {
  py::object tips;
  py::object buttons;
  py::object orientations;
  py::object present;
};

// Commands of `steps` steps, or of one that is given without its axis, checked.
class Commands {
 public:
  Commands(const Given& given, std::optional<std::size_t> steps, std::size_t styluses)
      : styluses_(styluses) {
    const std::size_t rows = steps.value_or(1) * styluses;
    commands_.resize(rows);
    if (given.tips.is_none()) {
      if (given.buttons.is_none() && given.orientations.is_none() && given.present.is_none()) {
        return;
      }
      throw py::value_error("tips are missing: give them, or nothing else either");
    }
    // The axis of the styluses may be left out where there is one.
    const auto shapes = [&](std::optional<py::ssize_t> width) {
      std::vector<Shape> all;
      for (const bool without : {false, true}) {
        if (without && styluses != 1) continue;
        Shape& shape = all.emplace_back();
        if (steps) shape.push_back(static_cast<py::ssize_t>(*steps));
        if (!without) shape.push_back(static_cast<py::ssize_t>(styluses));
        if (width) shape.push_back(*width);
      }
      return all;
    };
    const auto tips = numbers(given.tips, "tips", shapes(3));
    std::optional<py::array_t<double>> orientations;
    std::optional<py::array_t<std::uint32_t>> buttons;
    std::optional<py::array_t<bool>> present;
    if (!given.orientations.is_none()) {
      orientations = numbers(given.orientations, "orientations", shapes(4));
    }
    if (!given.buttons.is_none()) buttons = bit_fields(given.buttons, "buttons", shapes({}));
    if (!given.present.is_none()) present = flags(given.present, "present", shapes({}));
    for (std::size_t r = 0; r < rows; ++r) {
      StylusCommand& command = commands_[r];
      if (present && !present->data()[r]) continue;
      command.present = true;
      command.tip = Vector3(tips.data() + 3 * r);
      if (orientations) {
        const double* q = orientations->data() + 4 * r;
        command.orientation = Quaternion(q[0], q[1], q[2], q[3]);
      }
      if (buttons) command.buttons = buttons->data()[r];
      const char* const fault = fault_of(command);
      if (fault == nullptr) continue;
      throw py::value_error("step " + std::to_string(r / styluses) + ", stylus " +
                            std::to_string(r % styluses) + ": " + fault);
    }
  }

  std::span<const StylusCommand> of(std::size_t step) const {
    return {commands_.data() + step * styluses_, styluses_};
  }

 private:
  std::size_t styluses_;
  std::vector<StylusCommand> commands_;
};

// Rows of one or several steps, copied from the run.
struct Rows {
  std::vector<double> time;
  std::vector<StylusRow> styluses;
  std::vector<ObjectRow> objects;
  std::vector<ContactRow> contacts;
  std::vector<std::int64_t> first{0};  ///< contact of each step, and the end

  void take(const SceneRun& run) {
    const StepRecord& record = run.record();
    time.push_back(record.time);
    for (int s = 0; s < record.stylus_count; ++s) {
      styluses.push_back(row_of(record.stylus[static_cast<std::size_t>(s)]));
    }
    objects.insert(objects.end(), run.objects().begin(), run.objects().end());
    const std::span<const ContactRow> now = run.contacts();
    contacts.insert(contacts.end(), now.begin(), now.end());
    first.push_back(static_cast<std::int64_t>(contacts.size()));
  }
};

// Copied as bytes: numpy copies structures field by field.
template <typename Row>
py::array rows(const std::vector<Row>& of, std::vector<py::ssize_t> shape) {
  py::array_t<Row> array(std::move(shape));
  if (!of.empty()) std::memcpy(array.mutable_data(), of.data(), of.size() * sizeof(Row));
  return array;
}

template <typename Row>
py::array rows(const std::vector<Row>& of) {
  return rows(of, std::vector<py::ssize_t>{static_cast<py::ssize_t>(of.size())});
}

template <typename Row>
py::array rows(const std::vector<Row>& of, std::size_t steps) {
  const auto count = static_cast<py::ssize_t>(steps);
  const auto width = steps == 0 ? py::ssize_t{0} : static_cast<py::ssize_t>(of.size()) / count;
  return rows(of, std::vector<py::ssize_t>{count, width});
}

struct Step {
  std::uint64_t number = 0;
  double time = 0.0;
  py::array styluses, objects, contacts;
};

struct Steps {
  py::array time, styluses, objects, contacts, first;
};

constexpr std::chrono::milliseconds kBetweenSignals(50);  ///< that Ctrl-C waits for, and a step

class PythonSimulation {
 public:
  PythonSimulation(const std::string& text, const std::string& file)
      : run_(file.empty() ? TomlTable::parse_text(text, "scene") : TomlTable::parse_file(file)),
        surfaces_(static_cast<std::size_t>(run_.simulation().object_count())) {}

  Step step(const py::object& tips, const py::object& buttons, const py::object& orientations,
            const py::object& present) {
    const Use use(*this);
    const Commands commands({tips, buttons, orientations, present}, {}, styluses());
    rows_ = Rows{};
    {
      const py::gil_scoped_release released;
      run_.step(commands.of(0));
    }
    rows_.take(run_);
    return {run_.record().force_step, run_.record().time, rows(rows_.styluses), rows(rows_.objects),
            rows(rows_.contacts)};
  }

  Steps step_many(const py::object& tips, const py::object& buttons, const py::object& orientations,
                  const py::object& present) {
    const Use use(*this);
    const auto shape = py::module_::import("numpy").attr("shape")(tips).cast<py::tuple>();
    if (shape.empty()) throw py::value_error("tips must have the shape (steps, styluses, 3)");
    const auto steps = shape[0].cast<std::size_t>();
    const Commands commands({tips, buttons, orientations, present}, steps, styluses());
    Rows all;
    {
      const py::gil_scoped_release released;
      auto looked = std::chrono::steady_clock::now();
      for (std::size_t k = 0; k < steps; ++k) {
        run_.step(commands.of(k));
        all.take(run_);
        const auto now = std::chrono::steady_clock::now();
        if (now - looked < kBetweenSignals) continue;
        looked = now;
        look_at_signals();
      }
    }
    return {rows(all.time), rows(all.styluses, steps), rows(all.objects, steps), rows(all.contacts),
            rows(all.first)};
  }

  void reset() {
    const Use use(*this);
    run_.reset();
  }

  void set_gravity(const py::object& gravity) {
    const Use use(*this);
    run_.set_gravity(Vector3(numbers(gravity, "gravity", {{3}}).data()));
  }

  py::bytes save_state() {
    const Use use(*this);
    const std::vector<std::byte> state = run_.save_state();
    return {reinterpret_cast<const char*>(state.data()), state.size()};
  }

  void load_state(const py::bytes& state) {
    const Use use(*this);
    const std::string_view bytes = state;
    run_.load_state({reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()});
  }

  py::array surface(const py::object& self, int i) {
    const Use use(*this);
    Points& x = surfaces_[object(i)];
    {
      const py::gil_scoped_release released;
      run_.surface(i, x);
    }
    return view<double>({x.rows(), 3}, x.data(), self);
  }

  PythonModel model(int i) const {
    object(i);
    return PythonModel(run_.model(i));
  }

  const SceneRun& run() const { return run_; }

 private:
  // One thread at a time, also while the interpreter is not held.
  class Use {
   public:
    explicit Use(PythonSimulation& of) : used_(of.used_) {
      if (used_.test_and_set()) {
        throw std::runtime_error("the simulation is used by another thread: give each its own");
      }
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use() { used_.clear(); }

   private:
    std::atomic_flag& used_;
  };

  std::size_t styluses() const { return static_cast<std::size_t>(run_.stylus_count()); }
  std::size_t object(int i) const {
    if (i >= 0 && i < run_.simulation().object_count()) return static_cast<std::size_t>(i);
    throw py::index_error("object is " + std::to_string(i) + "; use 0 to " +
                          std::to_string(run_.simulation().object_count() - 1));
  }

  SceneRun run_;
  std::vector<Points> surfaces_;
  Rows rows_;
  std::atomic_flag used_ = ATOMIC_FLAG_INIT;
};

template <typename Named>
std::vector<std::string> names(const std::vector<Named>& of) {
  std::vector<std::string> names;
  for (const Named& one : of) names.push_back(one.name);
  return names;
}

void bind_rows(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(StylusRow, present, contact, object, tool, tip, proxy, force, torque);
  PYBIND11_NUMPY_DTYPE(ObjectRow, asleep, solved, position, orientation, velocity, angular_velocity,
                       residual, energy);
  PYBIND11_NUMPY_DTYPE(ContactRow, object, kind, other, place, state, slipping, position, normal,
                       force, slip, area);
  module.attr("stylus_dtype") = py::dtype::of<StylusRow>();
  module.attr("object_dtype") = py::dtype::of<ObjectRow>();
  module.attr("contact_dtype") = py::dtype::of<ContactRow>();
}

}  // namespace

void bind_simulation(py::module_& module) {
  bind_rows(module);
  module.attr("GRAB") = kGrabButton;
  module.attr("RESET") = kResetButton;
  module.attr("STYLUS") = static_cast<int>(ContactKind::kStylus);
  module.attr("FLOOR") = static_cast<int>(ContactKind::kFloor);
  module.attr("OBJECT") = static_cast<int>(ContactKind::kObject);
  module.attr("SCENERY") = static_cast<int>(ContactKind::kScenery);
  module.attr("COUPLING") = static_cast<int>(ContactKind::kCoupling);
  py::class_<Step>(module, "Step", "What happened in one step. Arrays are copies of this step's.")
      .def_readonly("number", &Step::number, "k, from 0.")
      .def_readonly("time", &Step::time, "At its end, (k + 1) dt [s].")
      .def_readonly("styluses", &Step::styluses, R"((s) of irdm.stylus_dtype, all in W:

present, contact (0 free, 1 touching, 2 held), object (-1: none), tool (-1: none), tip [m], proxy [m], force on the stylus
[N], torque on it about the tip [N m].)")
      .def_readonly("objects", &Step::objects,
                    R"((objects) of irdm.object_dtype, at the end of the step:

asleep, solved (0: the contact problem had no finite solution and no force acted), position of the centre of mass [m] W,
orientation w x y z B to W, velocity [m/s] W, angular_velocity [rad/s] W, residual of the contact problem [m], energy: kinetic, elastic, of gravity (0 at the
origin) and tether [J]; nan of a dense or compressed response.)")
      .def_readonly("contacts", &Step::contacts,
                    R"((contacts) of irdm.contact_dtype: every force on every object.

object; kind (irdm.STYLUS, FLOOR, OBJECT, SCENERY, COUPLING: a stylus that leads it as its tool); other (number of stylus,
object, scenery); place (sample, also under a stylus' ball, or node on the floor, or -1); state, slipping; in W position [m], normal towards the object,
force on it [N], slip in the step [m]; area [m^2]. What is not known is nan. A contact of two objects is there for each.
The sum of an object's forces and its weight is the change of its momentum over dt, where it has no damping and no tether.)");
  py::class_<Steps>(module, "Steps",
                    "What happened in several steps. Arrays as in Step, with the step first.")
      .def_readonly("time", &Steps::time, "(steps) [s]")
      .def_readonly("styluses", &Steps::styluses, "(steps, s) of irdm.stylus_dtype.")
      .def_readonly("objects", &Steps::objects, "(steps, objects) of irdm.object_dtype.")
      .def_readonly("contacts", &Steps::contacts, "Of all steps, of irdm.contact_dtype.")
      .def_readonly(
          "first_contact", &Steps::first,
          "(steps + 1): contacts[first_contact[k]:first_contact[k + 1]] are those of the k-th.");
  using Self = PythonSimulation;
  py::class_<Self>(module, "SimulationCore")
      .def(py::init<const std::string&, const std::string&>(), py::arg("text"), py::arg("file"))
      .def("step", &Self::step, py::arg("tips") = py::none(), py::arg("buttons") = py::none(),
           py::arg("orientations") = py::none(), py::arg("present") = py::none(), R"(One step of dt.

tips: (s, 3) at the end of the step [m], W; None: nobody is there. buttons: (s), irdm.GRAB | irdm.RESET. orientations: (s, 4)
w x y z in W, of styluses that lead a tool. present: (s) of bool, who is there; None: all. With one stylus the axis s may be
left out. Returns a Step. Raises ValueError for another shape, numbers that are not finite or beyond 1e4 m, buttons that are
no whole numbers from 0 to 2^32 - 1, orientations whose length is not 1; TypeError for what is not an array of real numbers
(complex, masked).)")
      .def("step_many", &Self::step_many, py::arg("tips"), py::arg("buttons") = py::none(),
           py::arg("orientations") = py::none(), py::arg("present") = py::none(),
           R"(Several steps, with the interpreter free meanwhile.

tips: (steps, s, 3); buttons, orientations, present: (steps, s, ...); as of step(). Nothing is done where one of them is
wrong. Returns Steps. Raises as step(), and KeyboardInterrupt within 0.1 s: the steps until then have been done.)")
      .def("reset", &Self::reset,
           "Puts everything back to the start before the next step; its number goes on.")
      .def("save_state", &Self::save_state,
           R"(The state as bytes, settings and the last step included.

For this version of irdm on this kind of machine. A Simulation that loads it goes on as this one, to the bit.)")
      .def("load_state", &Self::load_state, py::arg("state"),
           R"(Goes on from a state of save_state().

The scene has to have the same models, styluses and scenery; positions and velocities at the start may differ, and are gone
back to by reset(). Raises irdm.Error, and leaves all as it is, where the state is of another scene or version, or damaged.)")
      .def(
          "surface",
          [](const py::object& self, int i) { return self.cast<Self&>().surface(self, i); },
          py::arg("object") = 0,
          R"(Where the surface nodes of an object are after the last step, (n, 3) [m], W.

Read-only and not copied: the next call for this object writes it anew. Raises IndexError.)")
      .def("model", &Self::model, py::arg("object") = 0,
           "The Model of an object. Raises IndexError.")
      .def_property_readonly(
          "dt", [](const Self& self) { return self.run().simulation().dt(); }, "[s]")
      .def_property_readonly(
          "next_step", [](const Self& self) { return self.run().simulation().next_step(); },
          "Number of the coming step.")
      .def_property_readonly(
          "stylus_count", [](const Self& self) { return self.run().stylus_count(); }, "s")
      .def_property(
          "gravity",
          [](const Self& self) {
            const Vector3& g = self.run().simulation().settings().gravity;
            return py::array_t<double>(3, g.data());
          },
          &Self::set_gravity,
          "(3) [m/s^2], W. What is set holds from the next step on. Raises ValueError, TypeError, "
          "irdm.Error.")
      .def_property_readonly(
          "object_names", [](const Self& self) { return names(self.run().scene().objects); },
          "By number.")
      .def_property_readonly(
          "scenery_names", [](const Self& self) { return names(self.run().scene().scenery); },
          "By number.");
}

}  // namespace irdm::python
