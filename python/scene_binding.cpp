// Scenes, stepped from Python with their state as arrays.

#include <memory>
#include <mutex>

#include "experiments/run/run.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"
#include "python/binding.hpp"

namespace ballast::python {
namespace {

/// A scene under way. What Python sees of its state is the memory that is stepped.
class SteppedScene {
 public:
  /// Grains are deposited first, or taken from the packings that are kept in that folder.
  SteppedScene(const std::filesystem::path& name, const std::vector<std::string>& overrides,
               const std::filesystem::path& packings)
      : scene_(read_scene(find_scene(name), overrides)) {
    bool is_interrupted = false;
    {
      GilRelease unlocked;
      const auto keep_going = [&] { return !(is_interrupted = unlocked.is_interrupted()); };
      Manifest manifest(name, overrides, "");
      prepare_run(scene_, {packings, keep_going, StatusLine::Style::quiet}, manifest, run_);
    }
    if (is_interrupted) throw py::error_already_set();
    stepper_ = std::make_unique<TimeStepper>(run_.system, scene_, run_.system.first_driven_wall());
  }

  /// Steps `count` times; calls back after each, and stops where that returns what is false.
  py::dict step(long count, const py::object& callback, const py::object& self) {
    if (count < 0) throw std::invalid_argument("count: expected a number >= 0");
    StepRecord record;
    bool keep_going = true;
    for (long k = 0; k < count && keep_going; ++k) {
      {
        const GilRelease unlocked;
        const std::lock_guard held(busy_);
        unsolved_ = "the last step failed: it has no problem and no impulses";
        record = stepper_->step(run_.state, run_.memory);
        unsolved_ = nullptr;
      }
      if (callback.is_none()) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      } else {
        const py::object reply = callback(self, as_dict(record));
        keep_going = reply.is_none() || py::bool_(reply);
      }
    }
    return as_dict(record);
  }

  MotionState& state() { return run_.state; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const RigidBody& body : run_.system.bodies) names.push_back(body.name);
    return names;
  }
  double time() const { return run_.state.time; }
  double h() const { return scene_.step; }
  FrictionProblem problem() const {
    const std::lock_guard held(busy_);
    if (unsolved_) throw std::runtime_error(unsolved_);
    return stepper_->problem();
  }
  py::array impulses() const {
    const std::lock_guard held(busy_);
    if (unsolved_) throw std::runtime_error(unsolved_);
    return in_threes(three_rows(stepper_->problem(), stepper_->impulses()));
  }

  /// From now on, until it is set again [N].
  void set_force(const std::string& name, const Doubles& force) {
    const Eigen::VectorXd f = vector_of(force, 3, "force");
    if (!f.allFinite()) throw std::invalid_argument("force is not finite");
    const std::lock_guard held(busy_);
    for (RigidBody& body : run_.system.bodies) {
      if (body.name != name) continue;
      if (body.freedom.translations == 0)
        throw std::invalid_argument(name + ": does not move freely: no force acts on it");
      body.force = {.constant = f};
      // What a driven wall is pushed with, along its normal.
      if (body.is_wall()) body.wall.load = {f.dot(body.wall.normal), f.dot(body.wall.normal)};
      return;
    }
    throw std::invalid_argument(name + ": no body or wall has this name");
  }

 private:
  static py::dict as_dict(const StepRecord& record) {
    py::dict d;
    for (const StepColumn& column : step_columns()) d[column.name] = record.*column.value;
    return d;
  }

  Scene scene_;
  PreparedRun run_;
  std::unique_ptr<TimeStepper> stepper_;
  const char* unsolved_ = "no step has been made";  ///< why there is no problem; null: there is one
  mutable std::mutex busy_;  ///< of who steps, without the interpreter's lock, or reads
};

/// A part of the bodies' state as an array: its memory, which lives as long as the scene. `stride`
/// [bytes] from body to body.
auto viewed(double* (*first)(MotionState&), py::ssize_t columns, std::size_t stride) {
  return [=](const py::object& self) {
    MotionState& state = self.cast<SteppedScene&>().state();
    const auto bodies = static_cast<py::ssize_t>(state.pose.size());
    return py::array(py::dtype::of<double>(), {bodies, columns},
                     {static_cast<py::ssize_t>(stride), py::ssize_t{8}}, first(state), self);
  };
}

}  // namespace

void add_scenes(py::module_& module) {
  using py::arg;
  py::class_<SteppedScene>(module, "Scene")
      .def(py::init<const std::filesystem::path&, const std::vector<std::string>&,
                    const std::filesystem::path&>())
      .def(
          "step",
          [](const py::object& self, long count, const py::object& callback) {
            return self.cast<SteppedScene&>().step(count, callback, self);
          },
          arg("count") = 1, arg("callback") = py::none(),
          "Steps so often; the last step's record: a number for each column of a run's record, "
          "zeros where count is 0. callback(scene, record) comes after each step, and ends the "
          "stepping with what is false, None excepted.")
      .def_property_readonly(
          "positions",
          viewed([](MotionState& s) { return s.pose[0].position.data(); }, 3, sizeof(Pose)),
          "Centres of mass [m], (n, 3).")
      .def_property_readonly(
          "rotations",
          viewed([](MotionState& s) { return s.pose[0].rotation.coeffs().data(); }, 4,
                 sizeof(Pose)),
          "Unit quaternions x, y, z, w, (n, 4).")
      .def_property_readonly(
          "velocities",
          viewed([](MotionState& s) { return s.velocity[0].data(); }, 3, sizeof(Vec3)),
          "Of the centres [m/s], (n, 3).")
      .def_property_readonly(
          "spins", viewed([](MotionState& s) { return s.spin[0].data(); }, 3, sizeof(Vec3)),
          "Angular velocities in the bodies' frames [rad/s], (n, 3).")
      .def_property_readonly("names", &SteppedScene::names, "Of the bodies, then of the walls.")
      .def_property_readonly("time", &SteppedScene::time, "[s]")
      .def_property_readonly("h", &SteppedScene::h, "Length of a step [s].")
      .def_property_readonly("impulses", &SteppedScene::impulses, "Its solution r [N s], (n, 3).")
      .def("last_problem", &SteppedScene::problem)
      .def("set_force", &SteppedScene::set_force, arg("name"), arg("force"),
           "From now on this force [N], world frame, is on that body or driven wall.");
  module.def("scenes", [] {
    std::vector<std::string> names;
    for (const auto& [name, title] : list_scenes()) names.push_back(name);
    return names;
  });
}

}  // namespace ballast::python
