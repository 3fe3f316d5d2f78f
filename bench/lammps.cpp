// SPDX-License-Identifier: BSL-1.0
// The few functions that are called are declared here, as in LAMMPS' library.h, so that its headers are not
// needed.
#include "lammps.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <stdexcept>

namespace nysalt::bench {

namespace {

struct library {
  void* file = dlopen("liblammps.so.0", RTLD_NOW | RTLD_LOCAL);

  template <class F>
  F* function(const char* name) const {
    void* const found = file ? dlsym(file, name) : nullptr;
    if (!found) throw std::runtime_error(fmt::format("there is no LAMMPS with a function {}", name));
    return reinterpret_cast<F*>(found);
  }
};

const library& the_library() {
  static const library it;
  return it;
}

void close_lammps(void* handle) { the_library().function<void(void*)>("lammps_close")(handle); }

void* open_lammps() {
  std::array<std::string, 5> words{"lammps", "-log", "none", "-screen", "none"};
  std::array<char*, 5> arguments{};
  for (std::size_t k = 0; k < words.size(); ++k) arguments[k] = words[k].data();
  void* const handle = the_library().function<void*(int, char**, void**)>("lammps_open_no_mpi")(
      static_cast<int>(arguments.size()), arguments.data(), nullptr);
  if (!handle) throw std::runtime_error("LAMMPS does not open");
  return handle;
}

}  // namespace

bool lammps_liquid::is_there() { return the_library().file != nullptr; }

lammps_liquid::lammps_liquid(double side, double cutoff, double skin, double step,
                             const phase_point<double, Eigen::Dynamic>& start)
    : handle_(open_lammps(), close_lammps), atoms_(start.size() / 3) {
  command("units lj");
  command("atom_style atomic");
  command(fmt::format("region box block 0 {0} 0 {0} 0 {0}", side));
  command("create_box 1 box");
  const auto atoms = static_cast<std::size_t>(atoms_);
  std::vector<int> numbers(atoms);
  for (std::size_t i = 0; i < atoms; ++i) numbers[i] = static_cast<int>(i) + 1;
  const std::vector<int> types(atoms, 1);
  const int made =
      the_library()
          .function<int(void*, int, const int*, const int*, const double*, const double*, const int*, int)>(
              "lammps_create_atoms")(handle_.get(), static_cast<int>(atoms), numbers.data(), types.data(),
                                     start.q.data(), start.p.data(), nullptr, 0);
  if (made != static_cast<int>(atoms)) throw std::runtime_error("LAMMPS does not take all atoms");
  command("mass 1 1.0");
  command(fmt::format("pair_style lj/cut {}", cutoff));
  command("pair_coeff 1 1 1.0 1.0");
  command("pair_modify shift yes");
  command(fmt::format("neighbor {} bin", skin));
  command("neigh_modify delay 0 every 1 check yes");
  command("fix 1 all nve");
  command("thermo 0");
  command(fmt::format("timestep {}", step));
  command("run 0");
}

void lammps_liquid::take_steps(std::int64_t steps) { command(fmt::format("run {} pre no post no", steps)); }

Eigen::VectorXd lammps_liquid::momenta() const {
  Eigen::VectorXd result(3 * atoms_);
  the_library().function<void(void*, const char*, int, int, void*)>("lammps_gather_atoms")(
      handle_.get(), "v", 1, 3, result.data());
  return result;
}

void lammps_liquid::command(const std::string& line) {
  the_library().function<char*(void*, const char*)>("lammps_command")(handle_.get(), line.c_str());
  if (the_library().function<int(void*)>("lammps_has_error")(handle_.get()) != 0) {
    throw std::runtime_error("LAMMPS refuses: " + line);
  }
}

}  // namespace nysalt::bench
