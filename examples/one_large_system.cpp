// SPDX-License-Identifier: BSL-1.0
// One large system on many cores, here or on a cluster: mpirun -n 4 example_one_large_system
//
// A kink of the phi^4 field runs along a chain of 100,000 sites. Threads, and then ranks, share the chain;
// any number of them prints the same lines.
#include <fmt/format.h>

#include <cmath>

#include "nysalt/communicators/mpi.hpp"
#include "nysalt/distributed_run.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [system]
/// H = sum p^2/2 + (q_{i+1} - q_i)^2/2 + mu (q_i^2 - 1)^2/4: a field between two vacua, -1 and 1, open at
/// both ends.
class kink_chain {
 public:
  static constexpr int dimension = Eigen::Dynamic;
  kink_chain(Eigen::Index sites, double mu) : sites_(sites), mu_(mu) {}
  Eigen::Index size() const { return sites_; }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < sites_; ++i) f[i] = at<T>([&](Eigen::Index j) { return q[j]; }, i);
  }

  // A LocalSystem: the force on a site reads the site itself and the ones before and after it.
  static constexpr int components = 1;
  Eigen::Index sites() const { return sites_; }
  static constexpr Eigen::Index reach() { return 1; }
  static constexpr bool is_periodic() { return false; }
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    for (Eigen::Index i = begin; i < end; ++i) f(0, i) = at<T>([&](Eigen::Index j) { return q(0, j); }, i);
  }
  template <class T>
  T potential_in_range(const site_columns<const T>& q, Eigen::Index begin, Eigen::Index end) const {
    T sum(0.0);
    for (Eigen::Index i = begin; i < end; ++i) {
      const T well = q(0, i) * q(0, i) - 1.0;
      sum += well * well * (0.25 * mu_);
      if (i == 0) continue;
      const T elongation = q(0, i) - q(0, i - 1);
      sum += elongation * elongation * 0.5;
    }
    return sum;
  }

 private:
  template <class T>
  T at(const auto& value, Eigen::Index i) const {
    const T x = value(i);
    const T left = i > 0 ? T(value(i - 1) - x) : T(0.0);
    const T right = i + 1 < sites_ ? T(value(i + 1) - x) : T(0.0);
    return left + right - x * (x * x - 1.0) * mu_;
  }
  Eigen::Index sites_;
  double mu_;
};
// [/system]

constexpr Eigen::Index sites = 100'000;
constexpr double mu = 0.02;  // a kink is some ten sites wide, so that it hardly feels the lattice
constexpr double speed = 0.6;
constexpr double h = 0.5;
constexpr std::int64_t steps = 400;

/// The kink of the continuous field, tanh((x - v t)/w) with w^2 = 2 (1 - v^2)/mu, at t = 0.
void kink(Eigen::Index first, std::span<double> q, std::span<double> p) {
  const double width = std::sqrt(2.0 * (1.0 - speed * speed) / mu);
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double x = (static_cast<double>(first) + static_cast<double>(i) - sites / 2) / width;
    q[i] = std::tanh(x);
    p[i] = -speed / width / (std::cosh(x) * std::cosh(x));
  }
}

/// Where q passes through zero in sites first, first + 1, ..., or -1.
double place_of_kink(const Eigen::VectorXd& q, Eigen::Index first) {
  for (Eigen::Index i = 0; i + 1 < q.size(); ++i) {
    if (q[i] < 0.0 && q[i + 1] >= 0.0) return static_cast<double>(first + i) - q[i] / (q[i + 1] - q[i]);
  }
  return -1.0;
}

/// In one process, by two threads.
double by_threads() {
  const kink_chain chain(sites, mu);
  phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd(sites), Eigen::VectorXd(sites)};
  kink(0, {start.q.data(), static_cast<std::size_t>(sites)},
       {start.p.data(), static_cast<std::size_t>(sites)});
  // [threads]
  const model shared = model(chain).on_threads(2);
  const auto end = integrate(make_stepper(shared, srkn6b(), h), start, steps).finish;
  // [/threads]
  return place_of_kink(end.q, 0);
}

void by_ranks(const communicator& ranks) {
  // [ranks]
  const kink_chain chain(sites, mu);
  distributed_run run(chain, srkn6b(), h, kink, ranks);  // kink() fills the sites of each rank
  const double before = run.energy();
  run.advance(steps);
  const double error = std::abs(run.energy() / before - 1.0);
  const auto ours = run.synchronous();  // of this rank's sites
  // [/ranks]
  double place = -1.0;
  for (const double found : all_gather(ranks, place_of_kink(ours.q, run.first_site()))) {
    place = std::max(place, found);
  }
  if (!ranks.is_first()) return;
  fmt::print("by ranks:   the kink is at {:.4f}, energy off by {:.0e} of itself\n", place, error);
  fmt::print("by threads: the kink is at {:.4f}\n", by_threads());
  fmt::print("the continuous field's is at {:.4f}\n", sites / 2 + speed * h * static_cast<double>(steps));
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  by_ranks(mpi_communicator());
  MPI_Finalize();
}

// Expected output:
// by ranks:   the kink is at 50119.8105, energy off by 4e-12 of itself
// by threads: the kink is at 50119.8105
// the continuous field's is at 50120.0000
