// SPDX-License-Identifier: BSL-1.0
// Summary of a fit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/judgement.hpp"

namespace nysalt {

/// Verdict on a fit. nothing_gained: it may be used, but a classical method that costs as much is as
/// good.
enum class verdict { usable, nothing_gained, not_usable };

/// Name of a verdict in programs and files: usable, nothing gained or not usable.
constexpr std::string_view to_string(verdict v) {
  constexpr std::array<std::string_view, 3> names{"usable", "nothing gained", "not usable"};
  return names[static_cast<std::size_t>(v)];
}

/// Everything about a fit: where it comes from, how good it is, and whether to use it.
struct fit_summary {
  /// One entry of theta.
  struct fitted_parameter {
    std::string name;       ///< name of the parameter in the family
    double value;           ///< learned, or fixed
    double standard_error;  ///< NaN where it is not known, see errors_withheld; infinite where the loss is
                            ///< flat; 0 if the user fixed the parameter
    bool free;              ///< false: fixed by the user, or held at its bound or by the guard
  };

  std::string family;               ///< name of the family
  std::string system;               ///< description of the system
  std::string reference;            ///< description of the reference that made the data
  std::string ensemble;             ///< description of the ensemble that the data start from
  std::string coordinates;          ///< qp, modes or energy: coordinates of the metric
  std::string derivatives;          ///< origin of the derivatives of the force
  double step = 0.0;                ///< step h of the data
  std::uint64_t seed = 0;           ///< seed of the data
  std::uint64_t held_out_seed = 0;  ///< seed of the held-out data
  bool held_out_is_new = true;      ///< false: the held-out data are those that were learned from
  std::string loss_name;            ///< name of the loss, see loss_choice
  int loss_steps = 1;               ///< steps of the longest window of the loss
  int trajectory_steps = 1;         ///< steps of the shortest trajectory of the data
  bool follows = true;     ///< false: of a loss of trajectories, the error exceeds a twentieth of the motion
  bool is_of_data = true;  ///< false: the loss asks no data, and these only judge

  std::vector<fitted_parameter> parameters;  ///< theta, with its uncertainty
  std::string errors_withheld;               ///< reason why standard errors are not known; empty: they are
  /// The loss that was minimised, at theta; one-step: mean over pairs of the sum over coordinates of
  /// r^2/Sigma.
  double loss = 0.0;
  double held_out_loss = 0.0;        ///< loss on held-out data
  double held_out_start_loss = 0.0;  ///< held-out loss of the parameters that the search began with
  double held_out_noise = 0.0;       ///< standard error of the difference of these two; 0 from one trajectory
  std::size_t samples = 0;           ///< number of pairs of the data
  std::size_t trajectories = 0;      ///< number of trajectories of the data
  std::size_t held_out_samples = 0;  ///< number of pairs of the held-out data

  /// The mean contribution of the parameters' uncertainty to the loss on new data. NaN from a single
  /// trajectory, and where the guard holds them.
  double expected_excess = 0.0;
  double deciding_trajectories = 0.0;  ///< number of trajectories on which that and the standard errors rest

  double condition =
      1.0;  ///< condition number of the Hessian: largest over smallest curvature, flat directions apart
  std::vector<std::vector<double>>
      flat_directions;                ///< flat directions of theta, which the data do not determine
  std::int64_t coordinates_used = 0;  ///< number of coordinates that the loss sums over
  std::vector<std::string> dropped;   ///< coordinates that never move
  int starts_tried = 1;               ///< number of searches
  std::string from;                   ///< name of the start that led here
  int iterations = 0;                 ///< iterations of the search that led here
  std::string guard;                  ///< frequencies on which the guard required stability
  std::string unguarded;              ///< objection of the guard to the optimum; empty: none
  bool is_in_valley = false;      ///< further iterations hardly lower the loss: other parameters do as well
  bool is_at_no_bound = true;     ///< false: a search ended at farthest_parameter
  bool is_held_by_guard = false;  ///< no minimum was admitted: this is as far as the guard lets go
  /// A range of z = h omega.
  struct gap {
    double low;   ///< lower end of the stability interval
    double high;  ///< upper end of the stability interval
  };
  std::vector<gap> gaps;           ///< unstable intervals of z between the bands
  double one_step_error = 0.0;     ///< root of the one-step loss on held-out data
  double trajectory_error = 0.0;   ///< error at the end of the held-out trajectories
  double reference_error = 0.0;    ///< error of the reference, in the measure of one_step_error
  bool reference_checked = false;  ///< false: the data hold no finishes by a finer reference

  nysalt::judgement judgement{};  ///< judgement of the returned parameters at the step
  double highest_frequency =
      0.0;  ///< highest frequency along the states that the guard examined; 0: not known
  double fitted_frequency = 0.0;    ///< frequency of the phase-fitted member that was tried; 0: there is none
  std::string source_of_frequency;  ///< where it is known from, in words
  /// The classical method of the same cost per unit time with the least held-out loss, of those that the
  /// system serves; if nothing is gained over it, it holds at its step. Empty if there is none.
  std::string rival;
  double rival_step = 0.0;         ///< step of the rival; 0: it is a member of the family
  double rival_loss = 0.0;         ///< held-out loss of the rival
  double loss_beside_rival = 0.0;  ///< held-out loss by the times that both have: all, or some
  double rival_noise = 0.0;        ///< standard error of the difference of these two
  bool gains_nothing = false;      ///< the loss is not smaller than the rival's, by means or by ranks
  /// A classical method.
  struct failing_method {
    std::string name;         ///< name of the method; empty: there is none
    double step = 0.0;        ///< step at which it costs as much
    double times_less = 0.0;  ///< factor by which its error is smaller, in the median over trajectories
    std::string reason;       ///< what its trial run showed
  };
  /// The classical method of the same cost that errs less than what is to be taken, or as little as the fit,
  /// and fails a trial run.
  failing_method failing_rival{};

  double data_seconds = 0.0;              ///< wall time of making the data
  double fit_seconds = 0.0;               ///< wall time that the fit took
  std::int64_t learning_evaluations = 0;  ///< force evaluations of data and fit

  bool usable = false;  ///< whether the method may be used: false if not_usable
  std::string reason;   ///< reason why the fit is not usable; else empty

  /// The verdict of three.
  nysalt::verdict verdict() const {
    return !usable         ? nysalt::verdict::not_usable
           : gains_nothing ? nysalt::verdict::nothing_gained
                           : nysalt::verdict::usable;
  }
  /// The verdict in words, with the reason or with what to take instead.
  std::string verdict_in_words() const;
  /// The method to take where nothing is gained, in words: a method with its step, or what the rival is.
  std::string what_to_take() const;
  /// Ratio of the held-out losses of the rival and of the fit.
  double gain() const { return rival_loss / loss_beside_rival; }
  /// What a classical method that fails the trial would do, in words; empty: there is none.
  std::string of_failing_rival() const;

  /// expected_excess over the loss; 0 where that is rounding, errors of 1e-12 of an increment.
  double excess_share() const { return loss <= 1e-24 ? 0.0 : expected_excess / loss; }

  /// Smallest sound number of deciding trajectories. From fewer the uncertainty is too small more often than
  /// not, as one trajectory in hundreds may outweigh the rest.
  static constexpr double too_few_decide = 10.0;
  /// Whether the uncertainty rests on too few trajectories to rely on.
  bool is_decided_by_few() const { return loss > 1e-24 && deciding_trajectories < too_few_decide; }

  /// A sentence about expected_excess.
  std::string uncertainty() const;

  /// Whether the method follows the data to the end, as measured by the loss.
  bool follows_to_the_end() const { return follows && loss_steps >= trajectory_steps; }

  /// Number of steps over which the method follows the data, in words; empty where it follows them to the
  /// end.
  std::string following() const;

  /// Summary of one line: parameters, losses and verdict.
  std::string brief() const;

  /// Full summary, a line for each item.
  std::string full() const;
};

}  // namespace nysalt
