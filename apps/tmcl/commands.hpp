// The sub-commands; each adds itself and, when the user calls it, leaves its exit code in the context.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace opentmcl::app {

struct Context;

void add_asm(CLI::App& app, Context& context);
void add_backup(CLI::App& app, Context& context);
void add_bridge(CLI::App& app, Context& context);
void add_calc(CLI::App& app, Context& context);
void add_completion(CLI::App& app, Context& context);
void add_coord(CLI::App& app, Context& context);
void add_dap(CLI::App& app, Context& context);
void add_debug(CLI::App& app, Context& context);
void add_dis(CLI::App& app, Context& context);
void add_doctor(CLI::App& app, Context& context);
void add_explain(CLI::App& app, Context& context);
void add_farm(CLI::App& app, Context& context);
void add_flash(CLI::App& app, Context& context);
void add_fmt(CLI::App& app, Context& context);
void add_get(CLI::App& app, Context& context);
void add_home(CLI::App& app, Context& context);
void add_io(CLI::App& app, Context& context);
void add_lsp(CLI::App& app, Context& context);
void add_man(CLI::App& app, Context& context);
void add_monitor(CLI::App& app, Context& context);
void add_move(CLI::App& app, Context& context);
void add_plot(CLI::App& app, Context& context);
void add_record(CLI::App& app, Context& context);
void add_restore(CLI::App& app, Context& context);
void add_rotate(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_scan(CLI::App& app, Context& context);
void add_scenario(CLI::App& app, Context& context);
void add_send(CLI::App& app, Context& context);
void add_set(CLI::App& app, Context& context);
void add_sim(CLI::App& app, Context& context);
void add_spec(CLI::App& app, Context& context);
void add_stop(CLI::App& app, Context& context);
void add_store(CLI::App& app, Context& context);
void add_var(CLI::App& app, Context& context);
void add_version(CLI::App& app, Context& context);
void add_watch(CLI::App& app, Context& context);
void add_sim_ctl(CLI::App& sim, Context& context);  ///< below `sim`

}  // namespace opentmcl::app
