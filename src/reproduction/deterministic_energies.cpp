// SPDX-License-Identifier: BSL-1.0
// Energies of the chain along one trajectory: Figures 1 and 4.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parts.hpp"
#include "stiff_energies.hpp"

namespace nysalt::program::paper {

namespace {

/// Root mean square over the samples of (I - I_0)/I_0, of each trajectory.
std::vector<double> fluctuation(const std::vector<record>& runs) {
  std::vector<double> result;
  for (const auto& run : runs) {
    const double start = total(energies_at(run, 0));
    const std::size_t samples = run.values.size() / 3;
    double sum = 0.0;
    for (std::size_t i = 1; i < samples; ++i) {
      const double off = total(energies_at(run, i)) / start - 1.0;
      sum += off * off;
    }
    result.push_back(run.diverged_at ? std::numeric_limits<double>::quiet_NaN()
                                     : std::sqrt(sum / static_cast<double>(samples - 1)));
  }
  return result;
}

}  // namespace

exhibit energies_at_200(const setting& setup) {
  const auto system = chain();
  const double horizon = setup.pick(500.0, 5.0);
  const auto count = setup.pick<std::int64_t>(64, 16);
  const double fine = setup.pick(1e-4, 1e-3);
  constexpr double step = 0.02;
  constexpr double sample = 0.2;
  const method learned = learn_at(setup, *system, step, usual_learning_setup(setup)).method;
  const method verlet = classical("verlet", *system);
  const auto by_fine = followed(setup, *system, verlet, fine, horizon, sample, count, stiff);
  const auto by_verlet = followed(setup, *system, verlet, step, horizon, sample, count, stiff);
  const auto by_learned = followed(setup, *system, learned, step, horizon, sample, count, stiff);
  const auto of_fine = fluctuation(by_fine);
  const auto of_verlet = fluctuation(by_verlet);
  const auto of_learned = fluctuation(by_learned);
  const estimate fine_mean = mean_and_error(of_fine);
  const estimate more = paired_difference(of_learned, of_fine);
  const estimate verlet_mean = mean_and_error(of_verlet);
  const bool keeps = more.mean <= 0.2 * fine_mean.mean + 2.0 * more.standard_error;
  const std::string quantity =
      "root mean square of (I - I_0)/I_0 over the samples; fine steps have " + with_error(fine_mean);
  const std::string command =
      "nysalt run --system fpu --method verlet --step 0.02 --horizon 500 --trajectories 64 "
      "--sample-every 10 --observables stiff_energy,stiff_energy_1,stiff_energy_2,stiff_energy_3";
  return {"Energies at delta = 0.02",
          "Figure 1, section 2",
          {{"Verlet at delta = 0.02 is inaccurate", quantity, with_error(verlet_mean),
            verdict_of(verlet_mean.mean - 2.0 * verlet_mean.standard_error > 2.0 * fine_mean.mean),
            "it must be more than twice that of fine steps", command},
           {"at delta = 0.02 NySALT is as accurate as fine steps, and I is well conserved", quantity,
            with_error(mean_and_error(of_learned)), verdict_of(keeps),
            "at most a fifth more than that of fine steps, within two standard errors", ""}},
          {"Along one path nothing is predictable to t = 500; what is compared is how far I goes from its "
           "start."},
          {},
          {{{"energies_at_200",
             {energies_panel(by_fine[0], sample, fmt::format("Verlet, h = {:g}", fine)),
              energies_panel(by_verlet[0], sample, "Verlet, delta = 0.02"),
              energies_panel(by_learned[0], sample, "NySALT, delta = 0.02")},
             1500,
             460},
            "Stiff energies along one trajectory."}}};
}

namespace {

/// The first time at which I is above ten times its start; infinity if it never is.
double blown_up_at(const record& run, double sample) {
  const double start = total(energies_at(run, 0));
  const std::size_t samples = run.values.size() / 3;
  for (std::size_t i = 1; i < samples; ++i) {
    if (!(total(energies_at(run, i)) <= 10.0 * start)) return sample * static_cast<double>(i);
  }
  return run.diverged_at ? sample * static_cast<double>(samples) : std::numeric_limits<double>::infinity();
}

tested_claim blow_up(const std::vector<record>& by_verlet, double step) {
  std::vector<double> at;
  for (const auto& run : by_verlet) at.push_back(blown_up_at(run, step));
  const double latest = *std::max_element(at.begin(), at.end());
  const double earliest = *std::min_element(at.begin(), at.end());
  return {"at delta = 2/omega Verlet blows up within time 1",
          "time at which I is ten times its start, over trajectories",
          std::isfinite(latest) ? fmt::format("{:.2f} .. {:.2f}", earliest, latest) : "not all do",
          verdict_of(latest <= 1.0),
          "the latest must be at most 1",
          "nysalt run --system fpu --method verlet --step 0.04 --horizon 2 --trajectories 64 --observables "
          "stiff_energy"};
}

}  // namespace

exhibit energies_at_400(const setting& setup) {
  const auto system = chain();
  constexpr double step = 0.04;
  constexpr double sample = 0.4;
  const double horizon = setup.pick(150.0, 4.0);
  const auto count = setup.pick<std::int64_t>(200, 16);
  const auto learned = learn_at(setup, *system, step, usual_learning_setup(setup));
  const auto by_verlet =
      followed(setup, *system, classical("verlet", *system), step, 4.0, step, count, stiff);
  const auto by_learned = followed(setup, *system, learned.method, step, horizon, sample, count, stiff);
  const auto reference = reference_runs(setup, *system, sample, horizon, count);
  const auto lost =
      std::count_if(by_learned.begin(), by_learned.end(), [](const auto& r) { return r.diverged_at; });
  const std::size_t last = reference[0].values.size() / 3 - 1;
  table rows({"up to time", "NySALT", "frozen at the start"}, 0);
  std::vector<reading> readings;
  std::string ours;
  for (const double part : {0.1, 1.0 / 3.0, 1.0}) {
    const auto end = std::max<std::size_t>(1, static_cast<std::size_t>(part * static_cast<double>(last)));
    const auto learned_errors = means_up_to(by_learned, reference, energy_error, end);
    const auto frozen = means_up_to(reference, reference, energy_error, end, true);
    const std::string time = fmt::format("{:.3g}", sample * static_cast<double>(end));
    rows.add({time, with_error(mean_and_error(learned_errors)), with_error(mean_and_error(frozen))});
    const estimate gain = paired_difference(frozen, learned_errors);
    readings.push_back({"times up to " + time, gain.mean > 2.0 * gain.standard_error});
    ours += fmt::format("{}{} against {} up to {}", ours.empty() ? "" : "; ",
                        with_error(mean_and_error(learned_errors)), with_error(mean_and_error(frozen)), time);
  }
  return {
      "Energies at delta = 2/omega",
      "Figure 4, section 5.2",
      {blow_up(by_verlet, step),
       {"at delta = 2/omega NySALT remains stable to time 150", "trajectories that diverge",
        fmt::format("{} of {}", lost, count), verdict_of(lost == 0), "none must",
        "nysalt compare --system fpu --methods verlet,learned:nystrom --steps 0.04 --horizon 150 "
        "--trajectories 200 --for energy"},
       {"it captures the main patterns of the energy transfer up to time 150",
        "mean over times of sum |I_j - I_j^ref|/I^ref, against energies that are frozen at their start", ours,
        verdict_of("the time", readings),
        summary_of(readings) + "; it must be below the frozen ones by two standard errors",
        "nysalt compare --system fpu --methods learned:nystrom --steps 0.04 --horizon 150 --trajectories 200 "
        "--metric exchange --for energy"}},
      {},
      {{"Error of the exchange:", rows}},
      {{{"energies_at_400",
         {energies_panel(reference[0], sample, "reference"),
          energies_panel(by_learned[0], sample, "NySALT, delta = 0.04"),
          energies_panel(by_verlet[0], step, "Verlet, delta = 0.04")},
         1500,
         460},
        "Stiff energies along one trajectory."}}};
}

}  // namespace nysalt::program::paper
