#include "server/kept_eeprom.hpp"

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// Longer than the firmware ever waits between two page writes.
constexpr Microseconds quiet_time = 50 * one_millisecond;
constexpr Microseconds longest_fade = 5000 * one_millisecond;

Error as_error(const EepromFileError& error) {
  const bool is_bad = error.kind == EepromFileError::Kind::bad_content;
  return {is_bad ? ErrorKind::bad_file : ErrorKind::input_output, error.message, {}};
}

}  // namespace

Result<std::unique_ptr<KeptEeprom>> KeptEeprom::open(const std::string& path, const ModuleDescription& description) {
  Result<FileLock> lock = FileLock::acquire(path);
  if (!lock) return lock.error();
  return std::make_unique<KeptEeprom>(std::move(*lock), EepromFile(path, description));
}

Result<void> KeptEeprom::load(VirtualModule& module) {
  if (const auto error = file_.load(module.world().eeprom())) return as_error(*error);
  return {};
}

Result<EepromFile::Image> KeptEeprom::load(const EepromFile::Image& blank) {
  twin::Eeprom eeprom;
  eeprom.load(blank);
  if (const auto error = file_.load(eeprom)) return as_error(*error);
  return EepromFile::Image(eeprom.image());
}

Result<void> KeptEeprom::save(const VirtualModule& module) {
  if (const auto error = file_.save(module.world().eeprom())) return as_error(*error);
  return {};
}

Result<void> KeptEeprom::finish(VirtualModule& module) {
  let_eeprom_rest(module, module);
  return save(module);
}

void let_eeprom_rest(Simulated& simulated, const VirtualModule& module) {
  const Microseconds give_up = simulated.now() + longest_fade;
  std::uint64_t written = 0;
  do {
    written = module.world().eeprom().bytes_written();
    simulated.advance_to(simulated.now() + quiet_time);
  } while (module.world().eeprom().bytes_written() != written && simulated.now() < give_up);
}

}  // namespace opentmcl::server
