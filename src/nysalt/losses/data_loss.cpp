// SPDX-License-Identifier: BSL-1.0
#include "data_loss.hpp"

namespace nysalt::detail {

namespace {
template <Scalar R>
data_loss made(const loss_inputs& from, const window_error<R>& error) {
  const auto loss =
      std::make_shared<const after_steps<R>>(from.family, from.system, from.data, error, from.how);
  return without_type(loss, from.measure);
}
}  // namespace

data_loss after_steps_of(const loss_inputs& from, const window_error<lanes>& error) {
  return made(from, error);
}
data_loss after_steps_of(const loss_inputs& from, const window_error<double>& error) {
  return made(from, error);
}

}  // namespace nysalt::detail
