// SPDX-License-Identifier: BSL-1.0
// Systems whose force is local on a sequence of sites, so that threads and ranks can share one trajectory.
#pragma once

#include <concepts>
#include <type_traits>

#include "nysalt/system.hpp"

namespace nysalt {

/// A view of the values of consecutive sites, one array for each component of a site: entry (c, i) is
/// component c of site i, i being the number of the site in the whole system.
template <class T>
class site_columns {
 public:
  /// The values of sites first_site, first_site + 1, ...; the values of component c begin at values[c *
  /// stride].
  site_columns(T* values, Eigen::Index first_site, Eigen::Index stride)
      : values_(values), first_site_(first_site), stride_(stride) {}
  /// A view of the same values as constants.
  operator site_columns<const T>() const  // NOLINT(google-explicit-constructor)
    requires(!std::is_const_v<T>)
  {
    return {values_, first_site_, stride_};
  }

  /// Component c of site i.
  T& operator()(Eigen::Index c, Eigen::Index i) const { return values_[c * stride_ + (i - first_site_)]; }

 private:
  T* values_;
  Eigen::Index first_site_;
  Eigen::Index stride_;
};

namespace detail {
using columns = site_columns<double>;
using constant_columns = site_columns<const double>;

/// A class that derives from a system and has another force inherits ranges that are not of that force: they
/// count only if they are written in the class of the force or further down, as a kick does.
template <class S>
concept HasForceInRange = requires(const S& s, const constant_columns& q, const columns& f, Eigen::Index i) {
  s.template force_in_range<double>(q, f, i, i);
  requires std::is_base_of_v<typename decltype(origin_of_force<S, double>())::type,
                             typename written_in<decltype(&S::template force_in_range<double>)>::type>;
};
template <class S>
concept HasKickInRange = requires(const S& s, const constant_columns& q, const columns& p, Eigen::Index i) {
  s.template kick_in_range<double>(q, p, 1.0, i, i);
  requires std::is_base_of_v<typename written_in<decltype(&S::template force_in_range<double>)>::type,
                             typename written_in<decltype(&S::template kick_in_range<double, double>)>::type>;
};
template <class S>
concept HasPotentialInRange = requires(const S& s, const constant_columns& q, Eigen::Index i) {
  { s.template potential_in_range<double>(q, i, i) } -> std::same_as<double>;
};
}  // namespace detail

/// A system on a sequence of sites 0 .. sites() - 1: coordinate components * i + c is component c of site i,
/// and the force on a site reads the sites at most reach() away. Steps of words of A and B then apply many
/// letters to a tile of sites while the tile is in the cache, and threads and ranks share the tiles
/// (docs/how-to/one_large_system.md). V is a type of view below, site_columns<const T>, and W
/// site_columns<T>.
///
///   static constexpr int components = 1;   coordinates of a site
///   Eigen::Index sites() const;
///   Eigen::Index reach() const;
///   bool is_periodic() const;              whether site 0 follows the last site. Then views also hold
///   images:
///                                          site -1 is the last site, and site sites() the first
///   template <class T> void force_in_range(const V& q, const W& f, Eigen::Index begin, Eigen::Index end)
///   const;
///                                          the force on sites begin .. end - 1, with the bits of force()
///
/// It may have, beside these:
///
///   Eigen::Index sites_of_row() const;     ranges begin and end at multiples of this number
///   template <class T, class C> void kick_in_range(const V& q, const W& p, const C& c, begin, end) const;
///                                          p += c force_in_range(q), with the bits of kick()
///   template <class T> T potential_in_range(const V& q, begin, end) const;
///                                          the terms of V(q) that belong to these sites, each term to one
///                                          site: the energies of distributed runs are sums of these
template <class S>
concept LocalSystem =
    NystromSystem<S> && !BlackBoxForce<S> && detail::HasForceInRange<S> && requires(const S& s) {
      { S::components } -> std::convertible_to<int>;
      { s.sites() } -> std::convertible_to<Eigen::Index>;
      { s.reach() } -> std::convertible_to<Eigen::Index>;
      { s.is_periodic() } -> std::convertible_to<bool>;
    };

}  // namespace nysalt
