// SPDX-License-Identifier: BSL-1.0
// Export to LAMMPS.
#include <fmt/format.h>

#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

namespace {

struct stages {
  std::vector<std::size_t> ends;  ///< letters before the force of each stage
};

/// A stage ends before the first kick after a drift: there LAMMPS computes the force. Kicks at the end follow
/// the force of the last stage.
stages stages_of(const exported_letters& word) {
  stages result;
  bool has_moved = false;
  for (std::size_t i = 0; i < word.letters.size(); ++i) {
    if (word.letters[i] == 'A') has_moved = true;
    if (word.letters[i] != 'B' || !has_moved) continue;
    result.ends.push_back(i);
    has_moved = false;
  }
  if (has_moved) result.ends.clear();
  return result;
}

}  // namespace

std::string export_to_lammps(const exported_method& method) {
  const exported_letters word = composition_in_bath_of(method, "LAMMPS");
  const stages found = stages_of(word);
  if (found.ends.empty()) {
    refuse_export(
        "export: the word for lammps, which computes one force at the end of each step, must have no drift "
        "after its last kick, got {} with the letters {}; learn bab2 to bab6, or take verlet, bcss2v, bcss3 "
        "or bcss4",
        method.method.name(), word.letters);
  }
  auto values = values_of_header(method, "//");
  std::string list, ends;
  for (std::size_t i = 0; i < word.letters.size(); ++i)
    list += fmt::format("{}{{'{}', {}}}", i == 0 ? "" : ", ", word.letters[i], digits(word.coefficients[i]));
  for (const std::size_t end : found.ends) ends += fmt::format("{}{}", ends.empty() ? "" : ", ", end);
  values.emplace_back("LIST", list);
  values.emplace_back("ENDS", ends);
  values.emplace_back("STAGES", std::to_string(found.ends.size()));
  values.emplace_back("STEPS",
                      fmt::format("{} step{}", found.ends.size(), found.ends.size() == 1 ? "" : "s"));
  const bool in_bath = has_bath(method);
  values.emplace_back("ARGUMENTS", in_bath ? " TEMPERATURE FRICTION SEED" : "");
  values.emplace_back("COUNT", in_bath ? "6" : "3");
  add_bath(values, method,
           {{"BATH_SENTENCE", R"(
// FRICTION is one over a time. Noise is a function of SEED, step and tag, the same for any number of processes.)"},
            {"DECAY", "\n    const double decay = std::exp(-atoms.friction() * c * h);"},
            {"BATH_BRANCH", R"(        if (name == 'O')
          v[d] = decay * v[d] + std::sqrt((1 - decay * decay) * atoms.temperature() / m) * atoms.normal(i, k, d);
)"},
            {"BATH_NORMAL", R"(
// A standard normal number for each place: splitmix64 [Steele, Lea and Flood, OOPSLA 2014, figure 2], Box and Muller.
inline double normal_of_@NAME@(std::uint64_t seed, std::uint64_t tag, std::uint64_t step, std::uint64_t place) {
  const auto mixed = [](std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  };
  std::uint64_t z = seed;
  for (const std::uint64_t word : {tag, step, place}) z = mixed(z + word + 0x9e3779b97f4a7c15u);
  const double u = (static_cast<double>(mixed(z) >> 11) + 0.5) / 9007199254740992.0;  // 2^53
  const double w = static_cast<double>(mixed(z + 0x9e3779b97f4a7c15u) >> 11) / 9007199254740992.0;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::acos(-1.0) * w);
}
)"},
            {"BATH_ATOMS", R"(  double friction() const { return held.friction; }
  double temperature() const { return held.temperature * force->boltz / force->mvv2e; }
  double normal(int i, int letter, int d) const {
    return normal_of_@NAME@(held.seed, atom->tag[i], update->ntimestep, 3 * letter + d);
  }
)"},
            {"BATH_STANDS_IN", R"(  int drawn;
  double friction() const { return 1.5; }
  double temperature() const { return 0.7; }
  double normal(int, int, int d) { return d == 0 ? std::sin(static_cast<double>(++drawn)) : 0.0; }
)"},
            {"BATH_DRAWN", ", 0"},
            {"BATH_MEMBERS", "    bath_@NAME@ held = {0, 0, 0};\n"},
            {"BATH_TYPE", R"(struct bath_@NAME@ {
  double temperature, friction;
  std::uint64_t seed;
};
)"},
            {"BATH_READ", R"(
    held.temperature = utils::numeric(FLERR, arg[3], false, lmp);
    held.friction = utils::numeric(FLERR, arg[4], false, lmp);
    held.seed = utils::bnumeric(FLERR, arg[5], false, lmp);
    if (held.temperature < 0 || held.friction < 0) error->all(FLERR, std::string("nysalt/@NAME@: needs a temperature and friction >= 0"));
    if (!atom->tag_enable) error->all(FLERR, std::string("nysalt/@NAME@: needs atom IDs"));)"},
            {"BATH_HELD", ", held"},
            {"BATH_CONSTRUCTED", ", const bath_@NAME@& held"},
            {"BATH_INITIALISED", ", held(held)"},
            {"BATH_FIELD", "  const bath_@NAME@& held;\n"}});
  return fill(R"(@HEADER@//
@EXPLAINED@
// A fix of LAMMPS for a plug-in. LAMMPS computes one force a step, so that a step of the method is @STEPS@ of LAMMPS:
//   timestep T                      # h = @STAGES@ T
//   fix ID GROUP nysalt/@NAME@@ARGUMENTS@
// Positions and velocities are those of the method every @STEPS@ from the start of a run, and a run must have a multiple
// of @STEPS@. Neither rigid bodies nor constraints nor rRESPA.@BATH_SENTENCE@
// Test, of a stand-in with the loop of LAMMPS: c++ -DNYSALT_SELF_TEST -x c++ FILE && ./a.out
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#ifndef NYSALT_SELF_TEST
#include "atom.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "update.h"
#include "utils.h"
#endif

namespace nysalt_@NAME@ {

struct letter {
  char name;
  double c;
};
constexpr letter letters[] = {@LIST@};
constexpr int count = sizeof(letters) / sizeof(letter);
constexpr int stages = @STAGES@;
constexpr int ends[stages] = {@ENDS@};  // letters before the force of each stage

// Letters from .. to - 1, for a step h of the method.
template <class Atoms>
void act(int from, int to, double h, Atoms& atoms) {
  for (int k = from; k < to; ++k) {
    const char name = letters[k].name;
    const double c = letters[k].c;@DECAY@
    for (int i = 0; i < atoms.size(); ++i) {
      if (!atoms.moves(i)) continue;
      const double m = atoms.mass(i);
      double *x = atoms.x(i), *v = atoms.v(i), *f = atoms.f(i);
      for (int d = 0; d < 3; ++d) {
        if (name == 'A') x[d] += c * h * v[d];
        if (name == 'B') v[d] += c * h * atoms.force_unit() / m * f[d];
@BATH_BRANCH@      }
    }
  }
}
// What comes before the force of a stage, and after that of the last.
template <class Atoms>
void before_force(int stage, double h, Atoms& atoms) {
  act(stage == 0 ? 0 : ends[stage - 1], ends[stage], h, atoms);
}
template <class Atoms>
void after_force(int stage, double h, Atoms& atoms) {
  if (stage == stages - 1) act(ends[stage], count, h, atoms);
}

}  // namespace nysalt_@NAME@

#ifndef NYSALT_SELF_TEST
namespace LAMMPS_NS {

@BATH_TYPE@@BATH_NORMAL@
// The atoms of a group on this process.
struct group_@NAME@ : protected Pointers {
  group_@NAME@(LAMMPS* lmp, int bit, int count@BATH_CONSTRUCTED@) : Pointers(lmp), bit(bit), count(count)@BATH_INITIALISED@ {}
  int size() const { return count; }
  bool moves(int i) const { return atom->mask[i] & bit; }
  double mass(int i) const { return atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]]; }
  double* x(int i) const { return atom->x[i]; }
  double* v(int i) const { return atom->v[i]; }
  double* f(int i) const { return atom->f[i]; }
  double force_unit() const { return force->ftm2v; }
@BATH_ATOMS@  int bit, count;
@BATH_FIELD@};

class fix_@NAME@ : public Fix {
 public:
  fix_@NAME@(LAMMPS* lmp, int narg, char** arg) : Fix(lmp, narg, arg) {
    if (narg != @COUNT@) error->all(FLERR, std::string("nysalt/@NAME@: expected fix ID GROUP nysalt/@NAME@@ARGUMENTS@"));@BATH_READ@
    time_integrate = 1;
    dynamic_group_allow = 1;
  }
  int setmask() override { return FixConst::INITIAL_INTEGRATE | FixConst::FINAL_INTEGRATE; }
  void init() override {
    if ((update->laststep - update->firststep) % nysalt_@NAME@::stages != 0)
      error->all(FLERR, std::string("nysalt/@NAME@: the steps of a run must be a multiple of @STAGES@"));
    stage = 0;
  }
  void initial_integrate(int) override {
    auto atoms = own();
    nysalt_@NAME@::before_force(stage, nysalt_@NAME@::stages * update->dt, atoms);
  }
  void final_integrate() override {
    auto atoms = own();
    nysalt_@NAME@::after_force(stage, nysalt_@NAME@::stages * update->dt, atoms);
    stage = (stage + 1) % nysalt_@NAME@::stages;
  }

 private:
  group_@NAME@ own() {
    return {lmp, groupbit, igroup == atom->firstgroup ? atom->nfirst : atom->nlocal@BATH_HELD@};
  }
  int stage = 0;
@BATH_MEMBERS@};

inline Fix* make_fix_@NAME@(LAMMPS* lmp, int narg, char** arg) { return new fix_@NAME@(lmp, narg, arg); }

}  // namespace LAMMPS_NS

#if __has_include("lammpsplugin.h")
#include "lammpsplugin.h"
#include "version.h"
extern "C" void lammpsplugin_init(void* lmp, void* handle, void* register_plugin) {
  lammpsplugin_t plugin = {};
  plugin.version = LAMMPS_VERSION;
  plugin.style = "fix";
  plugin.name = "nysalt/@NAME@";
  plugin.info = "a method written by nysalt";
  plugin.author = "nysalt";
  plugin.creator.v2 = reinterpret_cast<lammpsplugin_factory2*>(&LAMMPS_NS::make_fix_@NAME@);
  plugin.handle = handle;
  (*reinterpret_cast<lammpsplugin_regfunc>(register_plugin))(&plugin, lmp);
}
#endif
#else
// Two oscillators, the x of two atoms with the masses 1 and 2.
struct two_atoms {
  double q[2][3], u[2][3], g[2][3];
  int size() const { return 2; }
  bool moves(int) const { return true; }
  double mass(int i) const { return i + 1; }
  double* x(int i) { return q[i]; }
  double* v(int i) { return u[i]; }
  double* f(int i) { return g[i]; }
  double force_unit() const { return 1; }
  void compute() {
    const double x = q[0][0], y = q[1][0];
    g[0][0] = -x - 2 * x * y;
    g[1][0] = -y - x * x + y * y;
  }
@BATH_STANDS_IN@};

// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int main() {
  const double end_q[] = {@Q@}, end_p[] = {@P@};
  two_atoms atoms = {{{0.3, 0, 0}, {0.2, 0, 0}}, {{0.1, 0, 0}, {-0.125, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}@BATH_DRAWN@};
  atoms.compute();
  for (int k = 0; k < 10 * nysalt_@NAME@::stages; ++k) {
    nysalt_@NAME@::before_force(k % nysalt_@NAME@::stages, 0.1, atoms);
    atoms.compute();
    nysalt_@NAME@::after_force(k % nysalt_@NAME@::stages, 0.1, atoms);
  }
  double off = 0;
  for (int i = 0; i < 2; ++i)
    off = std::max({off, std::abs(atoms.q[i][0] - end_q[i]), std::abs((i + 1) * atoms.u[i][0] - end_p[i])});
  std::printf("@NAME@: off by %.1e\n", off);
  return off < 1e-13 ? 0 : 1;
}
#endif
)",
              values);
}

}  // namespace nysalt::detail
