#pragma once

#include <memory>
#include <string>

#include "boards/twin/eeprom_file.hpp"
#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "server/file_lock.hpp"

namespace opentmcl::server {

/// The file behind a module's EEPROM, and the lock that keeps a second module out of it.
class KeptEeprom {
 public:
  /// Errors: bad_file (another program has the file), input_output.
  static client::Result<std::unique_ptr<KeptEeprom>> open(const std::string& path,
                                                          const ModuleDescription& description);
  KeptEeprom(FileLock lock, EepromFile file) : lock_(std::move(lock)), file_(std::move(file)) {}

  /// Before the module's first turn. Errors: bad_file, input_output.
  client::Result<void> load(VirtualModule& module);
  /// What a module starts with that is still to be made; a file that does not exist is made from `blank`. Errors:
  /// bad_file, input_output.
  client::Result<EepromFile::Image> load(const EepromFile::Image& blank);
  /// Writes the file if the module has written to its EEPROM. Error: input_output.
  client::Result<void> save(const VirtualModule& module);
  /// The module is another one from now on.
  void note_exchange() { file_.note_exchange(); }
  /// Lets the module finish what it has been told to store, as a supply that fades slowly does, and saves it.
  client::Result<void> finish(VirtualModule& module);

 private:
  FileLock lock_;
  EepromFile file_;
};

/// Lets time pass until the module has stored what it has been told to store, for five seconds at most: a program that
/// stores something again and again would never be done. @param simulated the module, or the line that it is on
void let_eeprom_rest(Simulated& simulated, const VirtualModule& module);

}  // namespace opentmcl::server
