// SPDX-License-Identifier: BSL-1.0
#include "refusal.hpp"

fmt::format_context::iterator fmt::formatter<nysalt::program::number_in_message>::format(
    const nysalt::program::number_in_message& number, fmt::format_context& context) const {
  if (is_plain) return fmt::format_to(context.out(), "{:.12g}", number.value);
  return fmt::formatter<double>::format(number.value, context);
}
