// SPDX-License-Identifier: BSL-1.0
#include "by_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

/// Neighbouring rows of one trajectory.
struct piece {
  std::int64_t trajectory;
  std::size_t begin;
  std::size_t end;
};

std::vector<piece> pieces_of(std::string_view text, std::size_t begin) {
  std::vector<piece> all;
  while (begin < text.size()) {
    std::int64_t trajectory = 0;
    std::from_chars(text.data() + begin, text.data() + text.size(), trajectory);
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    if (all.empty() || all.back().trajectory != trajectory) all.push_back({trajectory, begin, begin});
    all.back().end = end;
    begin = end;
  }
  return all;
}

}  // namespace

void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to) {
  namespace ipc = boost::interprocess;
  try {
    const ipc::file_mapping file(from.c_str(), ipc::read_only);
    const ipc::mapped_region region(file, ipc::read_only);
    const std::string_view text(static_cast<const char*>(region.get_address()), region.get_size());
    const std::size_t head = std::min(text.find('\n'), text.size() - 1) + 1;
    auto pieces = pieces_of(text, head);
    std::ranges::stable_sort(pieces, {}, &piece::trajectory);
    atomic_file out(to, "sorted");  // a kill leaves one such file at most, which the next run writes again
    out.write(text.substr(0, head));
    for (const auto& one : pieces) out.write(text.substr(one.begin, one.end - one.begin));
    out.commit(true);
  } catch (const ipc::interprocess_exception& problem) {
    throw std::runtime_error(fmt::format("cannot read {}: {}", from.string(), problem.what()));
  }
}

}  // namespace nysalt::program
