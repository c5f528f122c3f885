#include "client_sdk/src/domains.hpp"
#include "tools/cohort/commands/command_lines.hpp"
#include "tools/cohort/cli/usage.hpp"

// Where a server is, and who asks.
namespace cohort::tool {

void add_server_option(CLI::App& app, std::string& server) {
  app.add_option("--server", server, "Address of the server")
      ->envname("COHORT_SERVER")
      ->default_val("127.0.0.1")
      ->type_name("ADDRESS");
}

void add_secure_option(CLI::App& app, std::filesystem::path& folder, const char* text) {
  app.add_option("--secure", folder, text)->envname("COHORT_SECURE")->type_name("DIR");
}

void add_domains(CLI::App& app, std::vector<std::uint32_t>& domains, const std::string& text) {
  app.add_option_function<std::string>(
         "--domain", [&domains](const std::string& value) { domains = parse_domains(value); }, text)
      ->envname("COHORT_DOMAIN")
      ->check(domain_range())
      ->type_name("N|A..B");
}

}  // namespace cohort::tool
