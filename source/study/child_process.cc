// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/open_mpi.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/simulation/signals.h>
#include <limber/study/child_process.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

extern char **environ;

namespace limber
{
  namespace
  {
    /** Start @p command with its output in @p log. */
    pid_t
    spawn(const std::vector<std::string> &command, const std::string &log)
    {
      isolate_from_jobs();

      std::vector<char *> words;
      for (const std::string &word : command)
        words.push_back(const_cast<char *>(word.c_str()));
      words.push_back(nullptr);

      posix_spawn_file_actions_t actions;
      posix_spawn_file_actions_init(&actions);
      posix_spawn_file_actions_addopen(
        &actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
      posix_spawn_file_actions_addopen(&actions,
                                       STDOUT_FILENO,
                                       log.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC |
                                         O_NOFOLLOW,
                                       0644);
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
      pid_t     child  = 0;
      const int failed = posix_spawnp(
        &child, words[0], &actions, nullptr, words.data(), environ);
      posix_spawn_file_actions_destroy(&actions);
      if (failed != 0)
        throw FileError("The program " + in_quotes(command.front()) +
                        " could not be started with its output in " +
                        in_quotes(log) + ": " + std::strerror(failed) +
                        ". Usually the folder is not writable or memory is "
                        "short. Choose another '--output-directory'.");
      return child;
    }



    ChildEnd
    end_from(const int status)
    {
      ChildEnd end;
      end.killed    = WIFSIGNALED(status);
      end.exit_code = end.killed ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
      return end;
    }
  } // namespace



  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::string              &log,
            const double                    time_limit)
  {
    constexpr double grace = 10; // s, from termination to killing
    const double     start = wall_time();
    const pid_t      child = spawn(command, log);
    int              sent = 0, passed_on = 0;
    int              status;
    for (useconds_t pause = 1000;;)
      {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child)
          break;
        if (ended < 0 && errno != EINTR)
          throw FileError("The end of the program " +
                          in_quotes(command.front()) +
                          " was not reported: " + std::strerror(errno) + ".");
        // Who stops this process alone means its child as well.
        if (caught_signal() != passed_on)
          kill(child, passed_on = caught_signal());
        const double elapsed = wall_time() - start;
        if (sent == 0 && elapsed > time_limit)
          kill(child, sent = SIGTERM);
        else if (sent == SIGTERM && elapsed > time_limit + grace)
          kill(child, sent = SIGKILL);
        usleep(pause);
        pause = pause < 50000 ? 2 * pause : pause;
      }
    ChildEnd end  = end_from(status);
    end.timed_out = sent != 0;
    end.seconds   = wall_time() - start;
    return end;
  }



  std::string
  this_program()
  {
    return std::filesystem::read_symlink("/proc/self/exe").string();
  }
} // namespace limber
