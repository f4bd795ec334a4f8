// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/words.h>
#include <limber/simulation/command_line.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace limber
{
  namespace
  {
    const std::vector<std::string> known_options = {"--help",
                                                    "-h",
                                                    "--version",
                                                    "--validate",
                                                    "--print-parameters",
                                                    "--list",
                                                    "--set",
                                                    "--output-directory",
                                                    "--resume",
                                                    "--frequencies"};

    const std::vector<std::string> known_commands = {"study",
                                                     "stability",
                                                     "inf-sup",
                                                     "advise",
                                                     "reference",
                                                     "compare",
                                                     "plot",
                                                     "animate"};

    const std::map<std::string, PrintStyle> print_styles = {
      {"prm", PrintStyle::prm},
      {"json", PrintStyle::json},
      {"markdown", PrintStyle::markdown}};



    /** The words behind the program's name, taken one after the other. */
    class Arguments
    {
    public:
      Arguments(const int argc, const char *const *argv)
        : words(argv + (argc > 0 ? 1 : 0), argv + argc)
      {}

      bool
      at_end() const
      {
        return next == words.size();
      }

      /** An option and its value may be joined by '=' or follow each other. */
      std::string
      take_option()
      {
        const std::string word   = words[next++];
        const auto        equals = word.find('=');
        if (word.compare(0, 2, "--") != 0 || equals == std::string::npos)
          return word;
        words.insert(words.begin() + next, word.substr(equals + 1));
        joined = true;
        return word.substr(0, equals);
      }

      std::string
      take_value(const std::string &option, const std::string &example)
      {
        joined = false;
        if (at_end())
          throw InputError(
            "The option " + in_quotes(option) +
            " at the end of the command line lacks its value. "
            "Usually it was forgotten. Write " +
            in_quotes("limber scene.prm " + option + " " + example) +
            ", for instance.");
        return words[next++];
      }

      /** The option took no value: none may have been joined to it. */
      void
      check_no_value(const std::string &option) const
      {
        if (joined)
          throw InputError("The option " + in_quotes(option) +
                           " on the command line is followed by the value " +
                           in_quotes(words[next]) +
                           ", but it takes none. Write " + in_quotes(option) +
                           " alone.");
      }

    private:
      std::vector<std::string> words;
      std::size_t              next   = 0;
      bool                     joined = false;
    };



    PrintStyle
    to_print_style(const std::string &word)
    {
      const auto found = print_styles.find(word);
      if (found == print_styles.end())
        {
          const auto meant = nearest(word, {"prm", "json", "markdown"});
          throw InputError(
            "The style " + in_quotes(word) +
            " of '--print-parameters' on the command line is "
            "not known. Usually it is misspelt. Write prm, "
            "json or markdown." +
            (meant ? " Did you mean " + in_quotes(*meant) + "?" : ""));
        }
      return found->second;
    }



    /** Values in scenes have no blanks at their ends. */
    void
    check_folder(const std::string &folder)
    {
      if (folder != trimmed(folder) || folder.empty())
        throw InputError("The folder " + in_quotes(folder) +
                         " of '--output-directory' on the command line is "
                         "empty or has a blank at one of its ends. Usually "
                         "quotation marks are misplaced. Write "
                         "'--output-directory runs/first', for instance.");
    }



    void
    take_scene(const std::string &word, CommandLine &result)
    {
      if (word != "--" && word.front() == '-')
        {
          const auto meant = nearest(word, known_options);
          throw InputError("The option " + in_quotes(word) +
                           " on the command line is not known. Usually it is "
                           "misspelt. " +
                           (meant ? "Did you mean " + in_quotes(*meant) + "?" :
                                    "See all options with 'limber --help'."));
        }
      if (!result.scene.empty())
        throw InputError("There are two scenes on the command line, " +
                         in_quotes(result.scene) + " and " + in_quotes(word) +
                         ". Usually quotation marks are missing around a path "
                         "or a value. One run takes one scene.");
      result.scene = word;
    }
  } // namespace



  void
  check_first_word(const int argc, const char *const *argv)
  {
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty() || word.find_first_of("-./") == 0 ||
        word.find_first_of("./") != std::string::npos ||
        std::filesystem::exists(word))
      return; // an option or a scene
    const auto meant = nearest(word, known_commands);
    if (meant && *meant != word)
      throw InputError("The word " + in_quotes(word) +
                       " on the command line is neither a command nor a file. "
                       "Usually it is misspelt. Did you mean 'limber " +
                       *meant + "'?");
    if (!meant && argc > 2 && std::filesystem::is_regular_file(argv[2]))
      throw InputError("The word " + in_quotes(word) +
                       " on the command line is neither a command nor a file. "
                       "Usually it is a command of another program. Write "
                       "'limber " +
                       argv[2] + "' to run that scene.");
  }



  CommandLine
  parse_command_line(const int argc, const char *const *argv)
  {
    CommandLine result;
    Arguments   arguments(argc, argv);
    while (!arguments.at_end())
      {
        const std::string option = arguments.take_option();
        if (option == "--help" || option == "-h")
          result.help = true;
        else if (option == "--version")
          result.version = true;
        else if (option == "--validate")
          result.validate = true;
        else if (option == "--resume")
          result.resume = true;
        else if (option == "--print-parameters")
          result.print_parameters =
            to_print_style(arguments.take_value(option, "prm"));
        else if (option == "--list")
          result.list = arguments.take_value(option, "laws");
        else if (option == "--set")
          result.overrides.push_back(
            arguments.take_value(option, "\"End time=2\""));
        else if (option == "--frequencies")
          result.frequencies = arguments.take_value(option, "3");
        else if (option == "--output-directory")
          {
            result.output_directory =
              arguments.take_value(option, "runs/first");
            check_folder(*result.output_directory);
            result.overrides.push_back("Output/Directory=" +
                                       *result.output_directory);
          }
        else if (!option.empty())
          take_scene(option, result);
        arguments.check_no_value(option);
      }
    return result;
  }



  std::string
  usage()
  {
    return R"(limber [options] scene.prm             run a scene
mpirun -np 4 limber [options] scene.prm
limber COMMAND --help                  options of a command:

  reference   the scene of a solid in finite elements
  compare     fields and observables of a run against a reference, a run or
              'exact'
  study       error against cost: all variants of a scene
  stability   the largest stable step, or another entry, of all variants
  inf-sup     numerical inf-sup test of the pressures
  advise      settings that save time, and what each of them changes
  plot        pictures of runs, references and studies
  animate     a film of a run, or of several side by side

The scene is a .prm or .json file; '--' reads prm from standard input.

  --help, -h                            show this text
  --version                             show versions of program and libraries
  --validate                            check everything, run nothing
  --print-parameters prm|json|markdown  print all entries, those of a scene if
                                        one is given
  --list laws|kernels|schemes|shapes|sides|contact|exact
                                        show what there is to choose from
  --set "Section/Name=value"            change an entry; may be repeated
  --output-directory path               the run folder, same as Output/Directory
  --resume                              go on from the checkpoint of the folder

Exit codes: 0 finished, 1 wrong input, 2 computation failed, 3 file error,
4 a check was missed, 128 + n stopped by signal n.
)";
  }



  namespace
  {
    template <typename Enum>
    std::string
    word_lines(const Words<Enum> &words)
    {
      std::string result;
      for (const Word<Enum> &word : words)
        {
          std::string name = word.word;
          name.resize(20, ' ');
          result += name + word.text + "\n";
        }
      return result;
    }
  } // namespace



  std::string
  list_text(const std::string &topic)
  {
    if (topic == "laws")
      return word_lines(law_words());
    if (topic == "kernels")
      return word_lines(kernel_words());
    if (topic == "schemes")
      return "Transfer\n" + word_lines(transfer_words()) + "\nStress update\n" +
             word_lines(stress_update_words()) + "\nTime integration\n" +
             word_lines(time_integration_words()) + "\nLocking treatment\n" +
             word_lines(locking_words());
    if (topic == "shapes")
      return word_lines(shape_words());
    if (topic == "sides")
      return word_lines(side_condition_words());
    if (topic == "contact")
      return word_lines(contact_law_words());
    if (topic == "exact")
      return "None are built in. The formulas of a scene give initial states, "
             "loads and\nmoving sides; checks compare observables with "
             "numbers.\n";

    const auto meant = nearest(
      topic,
      {"laws", "kernels", "schemes", "shapes", "sides", "contact", "exact"});
    throw InputError("The topic " + in_quotes(topic) +
                     " of '--list' on the command line is not known. Usually "
                     "it is misspelt. " +
                     (meant ? "Did you mean " + in_quotes(*meant) + "?" :
                              "Write laws, kernels, schemes, shapes, sides, "
                              "contact or exact."));
  }
} // namespace limber
