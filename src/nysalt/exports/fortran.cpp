// SPDX-License-Identifier: BSL-1.0
// Export to Fortran 2008.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

namespace {

/// Numbers of a list, one on a line that goes on: lines of Fortran end after 132 letters.
std::string on_lines(const exported_letters& part) {
  if (part.coefficients.empty()) return "0d0";
  std::string result;
  for (const double c : part.coefficients)
    result += (result.empty() ? "" : ", &\n    ") + digits(std::vector<double>{c}, 'd');
  return result;
}

}  // namespace

std::string export_to_fortran(const exported_method& method) {
  auto values = values_of(method, "!", 'd');
  values.emplace_back("KERNEL_LINES", on_lines(kernel_of(method)));
  values.emplace_back("START_LINES", on_lines(start_of(method)));
  values.emplace_back("FINISH_LINES", on_lines(finish_of(method)));
  add_bath(values, method,
           {{"BATH_INTERFACE", R"(    subroutine normal_numbers(xi)
      import :: real64
      real(real64), intent(out) :: xi(:)
    end subroutine
)"},
            {"BATH", ", friction, temperature, normal"},
            {"BATH_OPTIONAL", R"(    real(real64), intent(in), optional :: friction, temperature
    procedure(normal_numbers), optional :: normal
    real(real64) :: xi(size(q)), decay
)"},
            {"BATH_BRANCH", R"(      if (letters(i:i) == 'O') then
        call normal(xi)
        decay = exp(-friction * c(k) * h)
        p = decay * p + sqrt((1 - decay**2) * temperature / inverse_mass) * xi
        k = k + 1
        cycle
      end if
)"},
            {"BATH_GIVEN", R"(    real(real64), intent(in) :: friction, temperature  ! the temperature is kT
    procedure(normal_numbers) :: normal
)"},
            {"BATH_PINNED", R"(  subroutine sines(xi)
    real(real64), intent(out) :: xi(:)
    integer :: i
    do i = 1, size(xi)
      drawn = drawn + 1
      xi(i) = sin(real(drawn, real64))
    end do
  end subroutine

)"},
            {"BATH_COUNTER", "  integer :: drawn = 0  ! by the self-test\n"},
            {"BATH_MADE", "    drawn = 0\n"},
            {"BATH_TEST", ", 1.5d0, 0.7d0, sines"}});
  return fill(R"(@HEADER@!
@EXPLAINED@
! A run is start once, steps, and finish on a copy of q and p that is observed; without a processor start and finish do
! nothing. A force that is known is not evaluated again, also from step to step.
! Test: a program of three lines: use nysalt_@NAME@; call self_test(off); print *, off
module nysalt_@NAME@
  implicit none
  private
  public :: start, steps, finish, self_test
  integer, parameter :: real64 = kind(1d0)
  abstract interface
    subroutine force_at(q, f)
      import :: real64
      real(real64), intent(in) :: q(:)
      real(real64), intent(out) :: f(:)
    end subroutine
@BATH_INTERFACE@  end interface
  character(*), parameter :: kernel = '@KERNEL@', before = '@START@', after = '@FINISH@'
  real(real64), parameter :: kernel_c(@KERNEL_SLOTS@) = [ &
    @KERNEL_LINES@]
  real(real64), parameter :: before_c(@START_SLOTS@) = [ &
    @START_LINES@]
  real(real64), parameter :: after_c(@FINISH_SLOTS@) = [ &
    @FINISH_LINES@]
@BATH_COUNTER@contains
  ! One pass over letters; f is the force at q where it is known.
  subroutine apply(letters, c, known, f, q, p, h, force, inverse_mass@BATH@)
    character(*), intent(in) :: letters
    real(real64), intent(in) :: c(:), h, inverse_mass(:)
    logical, intent(inout) :: known
    real(real64), intent(inout) :: f(:), q(:), p(:)
    procedure(force_at) :: force
@BATH_OPTIONAL@    real(real64) :: g(size(q))
    integer :: i, k
    k = 1
    do i = 1, len(letters)
      if (letters(i:i) == 'A') then
        q = q + c(k) * h * inverse_mass * p
        known = .false.
        k = k + 1
        cycle
      end if
@BATH_BRANCH@      if (.not. known) call force(q, f)
      known = .true.
      if (letters(i:i) == 'B') then
        p = p + c(k) * h * f
        k = k + 1
      else
        call force(q + c(k + 1) * h * h * inverse_mass * f, g)
        p = p + c(k) * h * g
        k = k + 2
      end if
    end do
  end subroutine

  subroutine start(q, p, h, force, inverse_mass)
    real(real64), intent(inout) :: q(:), p(:)
    real(real64), intent(in) :: h, inverse_mass(:)
    procedure(force_at) :: force
    real(real64) :: f(size(q))
    logical :: known
    known = .false.
    call apply(before, before_c, known, f, q, p, h, force, inverse_mass)
  end subroutine

  subroutine steps(q, p, h, count, force, inverse_mass@BATH@)
    real(real64), intent(inout) :: q(:), p(:)
    real(real64), intent(in) :: h, inverse_mass(:)
    integer, intent(in) :: count
    procedure(force_at) :: force
@BATH_GIVEN@    real(real64) :: f(size(q))
    logical :: known
    integer :: k
    known = .false.
    do k = 1, count
      call apply(kernel, kernel_c, known, f, q, p, h, force, inverse_mass@BATH@)
    end do
  end subroutine

  subroutine finish(q, p, h, force, inverse_mass)
    real(real64), intent(inout) :: q(:), p(:)
    real(real64), intent(in) :: h, inverse_mass(:)
    procedure(force_at) :: force
    real(real64) :: f(size(q))
    logical :: known
    known = .false.
    call apply(after, after_c, known, f, q, p, h, force, inverse_mass)
  end subroutine

  subroutine pinned(q, f)
    real(real64), intent(in) :: q(:)
    real(real64), intent(out) :: f(:)
    f(1) = -q(1) - 2 * q(1) * q(2)
    f(2) = -q(2) - q(1) * q(1) + q(2) * q(2)
  end subroutine

@BATH_PINNED@  ! By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding.
  subroutine self_test(off)
    real(real64), intent(out) :: off
    real(real64) :: q(2), p(2)
    real(real64), parameter :: end_q(2) = [@Q@], &
      end_p(2) = [@P@], inverse_mass(2) = [1d0, 0.5d0]
    q = [0.3d0, 0.2d0]
    p = [0.1d0, -0.25d0]
@BATH_MADE@    call start(q, p, 0.1d0, pinned, inverse_mass)
    call steps(q, p, 0.1d0, 10, pinned, inverse_mass@BATH_TEST@)
    call finish(q, p, 0.1d0, pinned, inverse_mass)
    off = max(maxval(abs(q - end_q)), maxval(abs(p - end_p)))
  end subroutine
end module
)",
              values);
}

}  // namespace nysalt::detail
