// SPDX-License-Identifier: BSL-1.0
#include "eigen.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/run_time_word.hpp"

template std::vector<nysalt::stability_window> nysalt::stability_windows<nysalt::run_time_word>(
    const run_time_word&, const std::vector<double>&);
