// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_command.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace exactcsg::cli_test {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string model(const std::string& name) {
  return EXACTCSG_SOURCE_DIR "/data/openscad/" + name + ".csg";
}

std::string program() { return EXACTCSG_BINARY_DIR "/exactcsg"; }

Finished run_command(const std::vector<std::string>& arguments, std::string_view input) {
  std::vector<std::string> words{program()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program(std::move(words), input);
}

Finished run_program(std::vector<std::string> words, std::string_view input) {
  const Folder folder;
  const std::string in = folder.write("stdin", input);
  const std::string out = folder.write("stdout", "");
  const std::string err = folder.write("stderr", "");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    const int files[] = {open(in.c_str(), O_RDONLY), open(out.c_str(), O_WRONLY | O_TRUNC),
                         open(err.c_str(), O_WRONLY | O_TRUNC)};
    for (int i = 0; i < 3; ++i) (void)dup2(files[i], i);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  (void)waitpid(child, &status, 0);
  Finished finished;
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  finished.out = read_text(out);
  finished.err = read_text(err);
  return finished;
}

}  // namespace exactcsg::cli_test
