// The register tables against words that are printed in the datasheets.
#include <gtest/gtest.h>

#include <type_traits>

#include "firmware/chip/register_field.hpp"
#include "firmware/chip/tmc262_registers.hpp"
#include "firmware/chip/tmc429_registers.hpp"

namespace opentmcl {
namespace {

template <class Left, class Right>
constexpr bool can_be_combined = requires(Left left, Right right) {
  left | right;
};

TEST(RegisterField, DoesNotMixBitsOfTwoRegisters) {
  EXPECT_TRUE((can_be_combined<chip::Word<tmc429::Mode>, chip::Word<tmc429::Mode>>));
  EXPECT_FALSE((can_be_combined<chip::Word<tmc429::Mode>, chip::Word<tmc429::Dividers>>));
  EXPECT_FALSE((std::is_invocable_v<decltype(tmc429::Mode::Ramp::in), chip::Word<tmc429::Dividers>>));
}

TEST(RegisterField, KeepsTheSignOfASignedField) {
  using Threshold = tmc262::StallGuardAndCurrent::Threshold;
  static_assert(Threshold::minimum == -64 && Threshold::maximum == 63);
  for (int threshold = Threshold::minimum; threshold <= Threshold::maximum; ++threshold) {
    EXPECT_EQ(Threshold::in(Threshold::of(threshold)), threshold);
  }
}

TEST(RegisterField, LosesBitsBeyondItsWidth) {
  using CurrentScale = tmc262::StallGuardAndCurrent::CurrentScale;
  EXPECT_EQ(CurrentScale::in(CurrentScale::of(32)), 0);
  EXPECT_EQ(CurrentScale::of(-1).bits, 0x1Fu);
}

TEST(RegisterField, ReplacesOnlyItself) {
  constexpr chip::Word<tmc429::Dividers> word{0x2306};
  static_assert(tmc429::Dividers::Ramp::replaced(word, 7) == chip::Word<tmc429::Dividers>{0x2706});
  static_assert(tmc429::Dividers::Pulse::in(word) == 2);
}

TEST(Tmc429Registers, GiveTheExampleDatagramsOfTheDatasheet) {
  // Page 19: write $000123 to DX_REF_TOLERANCE of motor 1, then read it back.
  static_assert(tmc429::write_datagram(tmc429::ReferenceTolerance::Value::of(0x123)) == 0x1A000123);
  static_assert(tmc429::read_datagram<tmc429::ReferenceTolerance>() == 0x1B000000);
}

TEST(Tmc429Registers, HaveTheAddressesOfTheMap) {
  using tmc429::address_of;
  static_assert(tmc429::read_datagram(address_of(tmc429::AxisRegister::actual_position)) == 0x03000000);
  static_assert(tmc429::write_datagram(tmc429::Word<tmc429::Mode>{}, 1) == 0x34000000);
  static_assert(tmc429::write_datagram(tmc429::Word<tmc429::Mode>{}, 2) == 0x54000000);
  static_assert(tmc429::read_datagram<tmc429::TypeVersion>() == 0x73000000);
  static_assert(tmc429::read_datagram<tmc429::ReferenceSwitches>() == 0x7D000000);
  static_assert(tmc429::write_datagram(tmc429::GlobalParameters::LastDriver::of(2)) == 0x7E000002);
  static_assert(tmc429::write_datagram(tmc429::InterfaceConfiguration::EnableStepDir::set |
                                       tmc429::InterfaceConfiguration::EnableRightSwitches::set |
                                       tmc429::InterfaceConfiguration::InterruptOutput::set) == 0x68000122);
}

TEST(Tmc429Registers, ReadTheStatusByteOfTheHardwareTrace) {
  // TYPE_VERSION on hardware: $14 $42 $91 $01, motors 2 and 3 at their target, motor 1 not.
  constexpr std::uint32_t reply = 0x14429101;
  constexpr auto status = tmc429::status_of(reply);
  static_assert(status == (tmc429::Status::AtTarget2::set | tmc429::Status::AtTarget3::set));
  static_assert(tmc429::data_of(reply) == tmc429::TypeVersion::value);
  static_assert(tmc429::Reply::AtTarget3::set.bits >> 24 == tmc429::Status::AtTarget3::set.bits);
  static_assert(tmc429::Reply::Interrupt::set.bits >> 24 == tmc429::Status::Interrupt::set.bits);
}

TEST(Tmc429Registers, PlaceTheFieldsAsTheMapDoes) {
  static_assert(tmc429::Mode::DisableLeftStop::mask == 0x000100);
  static_assert(tmc429::Mode::DisableRightStop::mask == 0x000200);
  static_assert(tmc429::Mode::SoftStop::mask == 0x000400);
  static_assert(tmc429::Mode::ReferenceIsRight::mask == 0x000800);
  static_assert(tmc429::Mode::LatchArmed::mask == 0x010000);
  static_assert(tmc429::Mode::of(tmc429::RampMode::hold).bits == 3);
  static_assert((tmc429::BrakingFactor::Multiplier::of(237) | tmc429::BrakingFactor::Divisor::of(4)).bits == 0x00ED04);
  static_assert(
      (tmc429::Dividers::Pulse::of(2) | tmc429::Dividers::Ramp::of(3) | tmc429::Dividers::MicrostepResolution::of(6))
          .bits == 0x002306);
  static_assert(tmc429::GlobalParameters::DriverClockDivider::in(tmc429::GlobalParameters::reset) == 15);
  static_assert(tmc429::GlobalParameters::Motor1RightIsReference3::mask == 0x200000);
  static_assert(tmc429::TargetVelocity::Value::in({0x801}) == -2047);
  static_assert(tmc429::ActualPosition::Value::in({0x800000}) == -0x800000);
}

TEST(Tmc262Registers, GiveTheExampleWordsOfTheDatasheet) {
  // Chapter 7.11: two spreadCycle settings, CS = 31, RDSEL = 1, 256 microsteps, coolStep.
  using Chopper = tmc262::ChopperConfiguration;
  static_assert(tmc262::datagram(Chopper::BlankTime::of(2) | Chopper::HysteresisEnd::of(3) |
                                 Chopper::HysteresisStart::of(3) | Chopper::OffTime::of(4)) == 0x901B4);
  static_assert(tmc262::datagram(Chopper::BlankTime::of(2) | Chopper::ConstantOffTime::set |
                                 Chopper::HysteresisEnd::of(10) | Chopper::HysteresisStart::of(5) |
                                 Chopper::OffTime::of(7)) == 0x94557);
  using Current = tmc262::StallGuardAndCurrent;
  static_assert(tmc262::datagram(Current::Filter::set | Current::CurrentScale::of(31)) == 0xD001F);
  static_assert(tmc262::datagram(tmc262::DriverConfiguration::of(tmc262::ReplyFormat::stall_guard)) == 0xE0010);
  static_assert(tmc262::datagram(tmc262::DriverControl::Resolution::of(0)) == 0x00000);
  using CoolStep = tmc262::CoolStepControl;
  static_assert(tmc262::datagram(CoolStep::MinimumCurrent::of(1) | CoolStep::HysteresisWidth::of(2) |
                                 CoolStep::HysteresisStart::of(2)) == 0xA8202);
}

TEST(Tmc262Registers, AreToldApartByTheirUpperBits) {
  using tmc262::register_select_of;
  using tmc262::RegisterSelect;
  static_assert(register_select_of(0x00000) == RegisterSelect::driver_control);
  static_assert(register_select_of(0x3FFFF) == RegisterSelect::driver_control);
  static_assert(register_select_of(0x40000) == RegisterSelect::unassigned);
  static_assert(register_select_of(0x901B4) == RegisterSelect::chopper_configuration);
  static_assert(register_select_of(0xA8202) == RegisterSelect::cool_step_control);
  static_assert(register_select_of(0xD001F) == RegisterSelect::stall_guard_and_current);
  static_assert(register_select_of(0xEF010) == RegisterSelect::driver_configuration);
  static_assert(
      tmc262::StallGuardAndCurrent::CurrentScale::in(tmc262::word_in<tmc262::StallGuardAndCurrent>(0xD001F)) == 31);
}

TEST(Tmc262Registers, ReadTheThreeReplyFormats) {
  constexpr chip::Word<tmc262::Reply> reply{0xAAC81};
  static_assert(tmc262::Reply::MicrostepPosition::in(reply) == 0x2AB);
  static_assert(tmc262::Reply::StallGuardUpperBits::in(reply) == 0x15);
  static_assert(tmc262::Reply::CurrentScale::in(reply) == 0x0B);
  static_assert(tmc262::Reply::Standstill::is_set(reply));
  static_assert(tmc262::Reply::StallGuardReached::is_set(reply));
  static_assert(!tmc262::Reply::OpenLoadA::is_set(reply));
}

}  // namespace
}  // namespace opentmcl
