// The sub-commands; each adds itself and, when the user calls it, leaves its exit code in the context.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace opentmcl::app {

struct Context;

void add_sim(CLI::App& app, Context& context);
void add_scenario(CLI::App& app, Context& context);
void add_sim_ctl(CLI::App& sim, Context& context);  ///< below `sim`
void add_farm(CLI::App& app, Context& context);
void add_asm(CLI::App& app, Context& context);
void add_dap(CLI::App& app, Context& context);
void add_debug(CLI::App& app, Context& context);
void add_dis(CLI::App& app, Context& context);
void add_fmt(CLI::App& app, Context& context);
void add_lsp(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_get(CLI::App& app, Context& context);
void add_set(CLI::App& app, Context& context);
void add_rotate(CLI::App& app, Context& context);
void add_move(CLI::App& app, Context& context);
void add_stop(CLI::App& app, Context& context);
void add_send(CLI::App& app, Context& context);
void add_spec(CLI::App& app, Context& context);
void add_version(CLI::App& app, Context& context);

}  // namespace opentmcl::app
