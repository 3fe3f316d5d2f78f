// SPDX-License-Identifier: BSL-1.0
// A cheap stiff force and a expensive soft one: r-RESPA, and what is learned in its place.
//
// Four masses are held by stiff bonds, and feel each other as charges: the bonds ask for short steps, the
// charges for few evaluations. r-RESPA kicks with the charges once in n short steps with the bonds. It pays
// for the phase of the bonds with many of these. Words of the same letters whose coefficients are learned at
// a step need few. Errors are those of the state on [0, 5]; costs are declared: 1 for the bonds and a price
// for the charges, a unit of time. Each row has the cheapest of all steps and words that are tried whose
// error is no larger.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"
#include "systems/bonded_chain.hpp"

using namespace nysalt;
using namespace examples;

const bonded_chain<4> chain(stiff_bonds<4>(20.0), soft_charges<4>(2.0));
const normal_around<4> starts({vector<double, 4>::Zero(), vector<double, 4>::Zero()}, 0.01, 0.3);

struct tried {
  std::string name;
  double step;
  int fast;  // evaluations of a step
  int slow;
  double error;
  double cost(double price) const { return (fast + price * slow) / step; }
};
using list = std::vector<tried>;

reference reference_at(double step) { return fine_steps(step / std::ceil(step / 0.004)); }

/// Tries a method of parts, or one of the whole force, which evaluates both each time.
void try_out(list& all, const method& method, double step) {
  const auto steps = static_cast<std::int64_t>(std::ceil(5.0 / step - 1e-9));
  const auto found = trajectory_errors(chain, reference_at(step), starts, method, state_measure(chain),
                                       {.step = step, .steps = steps, .trajectories = 64, .seed = 3});
  const word& letters = method.letters();
  const bool is_of_parts = evaluations_of_part(letters, 1) > 0;
  const int whole = letters.evaluations_per_step;
  all.push_back({method.name(), step, is_of_parts ? evaluations_of_part(letters, 0) : whole,
                 is_of_parts ? evaluations_of_part(letters, 1) : whole, found.methods[0].error.mean});
}

// [learn]
void try_learned(list& all, const family& family, double step) {
  const auto data = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, starts, reference_at(step),
                              {.step = step, .horizon = 24 * step, .trajectories = 16, .seed = seed});
  };
  const auto [theta, summary, method] = learn(family, chain, data(1), data(2), {.random_starts = 4});
  if (summary.usable) try_out(all, method, step);
}
// [/learn]

/// The cheapest whose error is no larger, and its cost relative to that of r-RESPA.
std::string cheapest(const list& all, double error, double price, double of_r_respa) {
  const tried* best = nullptr;
  for (const auto& one : all) {
    if (one.error <= error && (!best || one.cost(price) < best->cost(price))) best = &one;
  }
  if (!best) return "none";
  return fmt::format("{} at {}: {:.2f}", best->name, best->step, best->cost(price) / of_r_respa);
}

int main() {
  list respa, whole, learned;
  for (const double step : {0.16, 0.113, 0.08, 0.0566, 0.04, 0.0283, 0.02, 0.01414}) {
    try_out(respa, r_respa<0, 1, 4>{}, step);
    try_out(respa, r_respa<0, 1, 8>{}, step);
    try_out(respa, r_respa<0, 1, 16>{}, step);
    try_out(respa, r_respa<0, 1, 32>{}, step);
    try_out(respa, r_respa<0, 1, 64>{}, step);
    for (const double part : {1.0, 2.0, 4.0}) try_out(whole, srkn6b{}, part * step);
    for (const double part : {1.0, 2.0, 4.0}) try_out(whole, srkn14a{}, part * step);
  }
  try_learned(learned, nested_kicks<0, 1, 4, 2>{}, 0.226);
  try_learned(learned, nested_kicks<0, 1, 6, 2>{}, 0.226);
  try_learned(learned, nested_kicks<0, 1, 4, 2>{}, 0.113);
  for (const double price : {3.0, 10.0, 100.0}) {
    fmt::print("price 1:{}   cost of r-RESPA, and of the others relative to it\n", price);
    for (const double error : {0.1, 0.03, 0.01, 0.003, 0.001}) {
      double least = INFINITY;
      for (const auto& one : respa) {
        if (one.error <= error) least = std::min(least, one.cost(price));
      }
      fmt::print("{:>7}: {:>5.0f}  {:<30} {}\n", error, least, cheapest(learned, error, price, least),
                 cheapest(whole, error, price, least));
    }
  }
}

// Expected output:
// price 1:3   cost of r-RESPA, and of the others relative to it
//     0.1:   238  nested_4x2 at 0.226: 0.26      srkn6b at 0.0566: 1.79
//    0.03:   336  nested_4x2 at 0.226: 0.18      srkn6b at 0.0566: 1.26
//    0.01:   618  nested_6x2 at 0.226: 0.13      srkn14a at 0.1132: 0.80
//   0.003:  1237  nested_6x2 at 0.226: 0.06      srkn14a at 0.08: 0.57
//   0.001:  2475  nested_4x2 at 0.113: 0.05      srkn14a at 0.08: 0.28
// price 1:10   cost of r-RESPA, and of the others relative to it
//     0.1:   325  nested_4x2 at 0.226: 0.38      srkn6b at 0.0566: 3.59
//    0.03:   459  nested_4x2 at 0.226: 0.27      srkn6b at 0.0566: 2.54
//    0.01:   742  nested_6x2 at 0.226: 0.19      srkn14a at 0.1132: 1.83
//   0.003:  1484  nested_6x2 at 0.226: 0.10      srkn14a at 0.08: 1.30
//   0.001:  2970  nested_4x2 at 0.113: 0.08      srkn14a at 0.08: 0.65
// price 1:100   cost of r-RESPA, and of the others relative to it
//     0.1:  1025  nested_4x2 at 0.226: 0.90      srkn6b at 0.0566: 10.45
//    0.03:  1451  nested_4x2 at 0.226: 0.63      srkn6b at 0.0566: 7.38
//    0.01:  2332  nested_6x2 at 0.226: 0.40      srkn14a at 0.1132: 5.36
//   0.003:  4100  nested_6x2 at 0.226: 0.23      srkn14a at 0.08: 4.31
//   0.001:  8200  nested_4x2 at 0.113: 0.22      srkn14a at 0.08: 2.16
