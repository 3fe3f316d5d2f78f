// SPDX-License-Identifier: BSL-1.0
// One function a bundled system; each is compiled in its own file below systems/.
#pragma once

#include <cstdint>
#include <memory>

#include "bundled_system.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_fpu(std::int64_t pairs, double omega);
std::unique_ptr<bundled_system> make_oscillator(double omega);
std::unique_ptr<bundled_system> make_linear_chain(std::int64_t masses, double spring);
std::unique_ptr<bundled_system> make_pendulum();
std::unique_ptr<bundled_system> make_henon_heiles();

}  // namespace nysalt::program
