#include "manual.h"

#include <fmt/format.h>

#include <sstream>
#include <vector>

namespace beltrami::cli {

namespace {

/// An option or a positional argument, as its parser knows it.
struct Entry {
    std::vector<std::string> names;    ///< "-o", "--output"; empty: positional
    std::string value;                 ///< what stands after it; empty: a flag
    std::vector<std::string> choices;  ///< the only values, if there are few
    std::string text;
    bool required = false, several = false;
};

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

/// "TEXT:{none,unit}" of a type name: the words between the braces.
std::vector<std::string> choices_of(const std::string& type) {
    const std::size_t open = type.find(":{");
    return open == std::string::npos ? std::vector<std::string>()
                                     : split(type.substr(open + 2, type.find('}') - open - 2), ',');
}

Entry entry_of(const CLI::Option& option) {
    Entry entry;
    for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
    entry.text = option.get_description();
    entry.required = option.get_required();
    entry.several = option.get_items_expected_max() > 1;
    const bool flag = !entry.names.empty() && option.get_items_expected_max() == 0;
    if (flag) return entry;
    const std::string type = option.get_type_name();
    entry.choices = choices_of(type);
    entry.value = entry.names.empty() ? option.get_name(true) : type.substr(0, type.find(':'));
    return entry;
}

/// What the help shows; hidden options have no group.
std::vector<Entry> entries_of(const CLI::App& app) {
    std::vector<Entry> entries;
    const auto add = [&](const CLI::App& of) {
        for (const CLI::Option* option : of.get_options())
            if (!option->get_group().empty()) entries.push_back(entry_of(*option));
    };
    add(app);
    for (const CLI::App* group : app.get_subcommands({}))
        if (group->get_name().empty()) add(*group);  // option groups are nameless subcommands
    return entries;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    std::vector<const CLI::App*> commands;
    for (const CLI::App* command : app.get_subcommands({}))
        if (!command->get_name().empty()) commands.push_back(command);
    return commands;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
    return fmt::format("{}", fmt::join(words, between));
}

/// Text as roff has it: no line begins with a request, hyphens can be copied.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            result += c;
        }
    }
    return result;
}

std::string roff_entry(const Entry& entry) {
    std::string head =
        entry.names.empty() ? "\\fI" + roff(entry.value) + "\\fR" : "\\fB" + roff(joined(entry.names, ", ")) + "\\fR";
    if (!entry.names.empty() && !entry.value.empty()) head += " \\fI" + roff(entry.value) + "\\fR";
    std::string text = roff(entry.text);
    if (!entry.choices.empty()) text += (text.empty() ? "" : "; ") + roff("one of " + joined(entry.choices, ", "));
    return fmt::format(".TP\n{}\n{}\n", head, text.empty() ? "\\&" : text);
}

std::string verbatim(const std::string& text) {
    return ".nf\n" + roff(text) + "\n.fi\n";
}

/// A word between single quotes, for both shells.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
        } else {
            result += c;
        }
    }
    return result + "'";
}

/// The same inside the brackets of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

std::string zsh_argument(const Entry& entry) {
    const std::string action = entry.choices.empty() ? "_files" : "(" + joined(entry.choices, " ") + ")";
    const std::string value = fmt::format(":{}:{}", zsh_text(entry.value), action);
    if (entry.names.empty()) return "        " + quoted("*" + value) + " \\\n";
    std::string result;
    for (const std::string& name : entry.names)
        result += "        " +
                  quoted(fmt::format("*{}[{}]{}", name, zsh_text(entry.text), entry.value.empty() ? "" : value)) +
                  " \\\n";
    return result;
}

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& version, const std::string& exit_codes) {
    std::string page =
        fmt::format(".TH BELTRAMI 1 \"\" \"beltrami {}\" \"User Commands\"\n.SH NAME\nbeltrami \\- {}\n.SH SYNOPSIS\n",
                    version, "extremal quasiconformal maps of meshes");
    for (const CLI::App* command : commands_of(app)) {
        page += fmt::format(".B beltrami {}\n[\\fIoptions\\fR]", command->get_name());
        for (const Entry& entry : entries_of(*command))
            if (entry.names.empty()) {
                const std::string name = "\\fI" + roff(entry.value) + "\\fR" + (entry.several ? " ..." : "");
                page += entry.required ? " " + name : " [" + name + "]";
            }
        page += "\n.br\n";
    }
    page += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n.SH OPTIONS\n";
    for (const Entry& entry : entries_of(app)) page += roff_entry(entry);
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) {
        page += fmt::format(".SS beltrami {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
        for (const Entry& entry : entries_of(*command)) page += roff_entry(entry);
    }
    const std::string footer = app.get_footer();
    page += ".SH EXIT STATUS\n" + verbatim(exit_codes.substr(exit_codes.find('\n') + 1));
    page +=
        ".SH EXAMPLES\n" + verbatim(footer.substr(footer.find('\n') + 1, footer.find("\n\n") - footer.find('\n') - 1));
    return page;
}

std::string bash_completion(const CLI::App& app) {
    std::vector<std::string> names;
    std::string cases;
    for (const CLI::App* command : commands_of(app)) {
        names.push_back(command->get_name());
        std::vector<std::string> options;
        std::string values;
        for (const Entry& entry : entries_of(*command)) {
            options.insert(options.end(), entry.names.begin(), entry.names.end());
            if (!entry.names.empty() && !entry.choices.empty())
                values += fmt::format("                {}) words={} ;;\n", joined(entry.names, "|"),
                                      quoted(joined(entry.choices, " ")));
        }
        cases +=
            fmt::format("        {})\n            options={}\n            case \"$before\" in\n{}            esac ;;\n",
                        command->get_name(), quoted(joined(options, " ")), values);
    }
    std::vector<std::string> own;
    for (const Entry& entry : entries_of(app)) own.insert(own.end(), entry.names.begin(), entry.names.end());
    return fmt::format(R"(# bash completion for beltrami, made from the command's own parser
_beltrami() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options= words=
    COMPREPLY=()
    # "--option=value" comes as three words
    if [[ $word == = ]]; then
        word=
    elif [[ $before == = ]]; then
        before=${{COMP_WORDS[COMP_CWORD-2]}}
    fi
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W '{} {}' -- "$word"))
        return
    fi
    case "${{COMP_WORDS[1]}}" in
{}    esac
    if [[ -n $words ]]; then
        COMPREPLY=($(compgen -W "$words" -- "$word"))
    elif [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
    else
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}}
complete -F _beltrami beltrami
)",
                       joined(names, " "), joined(own, " "), cases);
}

std::string zsh_completion(const CLI::App& app) {
    std::string names;
    std::string cases;
    for (const CLI::App* command : commands_of(app)) {
        names += "        " + quoted(command->get_name() + ":" + zsh_text(command->get_description())) + "\n";
        cases += fmt::format("    {})\n        _arguments \\\n", command->get_name());
        for (const Entry& entry : entries_of(*command)) cases += zsh_argument(entry);
        cases += "        && return ;;\n";
    }
    return fmt::format(R"(#compdef beltrami
# made from the command's own parser
_beltrami() {{
    local -a commands=(
{}    )
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    local name=$words[2]
    shift words
    ((CURRENT--))
    case $name in
{}    esac
}}
_beltrami "$@"
)",
                       names, cases);
}

}  // namespace beltrami::cli
