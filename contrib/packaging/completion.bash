# Completion of bash for limber: commands, options, scenes, entries of --set, fields.

_limber_entries() {
  # 'Section/Name' of all entries, from the program itself
  limber --print-parameters prm "$@" 2>/dev/null | awk '
    $1 == "subsection" { sub(/^ *subsection +/, ""); path = path $0 "/"; next }
    $1 == "end" { sub(/[^\/]*\/$/, "", path); next }
    $1 == "set" { sub(/^ *set +/, ""); sub(/ *=.*/, ""); print path $0 "=" }'
}

_limber() {
  local word=$2 before=$3 command=run
  local commands="reference compare study stability inf-sup advise plot animate"
  local options
  COMPREPLY=()
  if ((COMP_CWORD > 1)) && [[ " $commands " == *" ${COMP_WORDS[1]} "* ]]; then
    command=${COMP_WORDS[1]}
  fi

  case $before in
    --print-parameters)
      mapfile -t COMPREPLY < <(compgen -W "prm json markdown" -- "$word")
      return ;;
    --list)
      mapfile -t COMPREPLY < <(compgen -W "laws kernels schemes shapes sides contact exact" \
        -- "$word")
      return ;;
    --set)
      local IFS=$'\n'
      mapfile -t COMPREPLY < <(compgen -W "$(_limber_entries)" -- "$word" |
        sed 's/[ '\'']/\\&/g')
      compopt -o nospace
      return ;;
    --field)
      local IFS=$'\n'
      mapfile -t COMPREPLY < <(compgen -W $'pressure\nspeed\nvelocity\nstress
displacement\nequivalent\\ stress\nvolume\\ ratio\nmass\nbody' -- "$word")
      return ;;
    --output-directory | --frames)
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      return ;;
  esac

  case $command in
    run) options="--help --version --validate --print-parameters --list --set
      --output-directory --resume" ;;
    reference) options="--help --frequencies --validate --set
      --output-directory" ;;
    compare) options="--help" ;;
    study) options="--help --short --for-error --resume --validate
      --print-parameters --set --output-directory" ;;
    stability) options="--help --short --resume --validate --print-parameters
      --set --output-directory" ;;
    inf-sup) options="--help --cells --pressure --points --fill --samples
      --output-directory --replace" ;;
    advise) options="--help --for-error --seconds --set" ;;
    plot) options="--help --field --body --enlarge --range --view --grid --labels
      --output --time --snapshots --columns" ;;
    animate) options="--help --field --body --enlarge --range --view --grid --labels
      --output --rate --frames" ;;
  esac

  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ $command == plot || $command == animate || $command == compare ]]; then
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(
      ((COMP_CWORD > 1)) || compgen -W "$commands" -- "$word"
      compgen -f -X '!*.@(prm|json)' -- "$word"
      compgen -d -- "$word")
  fi
}

shopt -s extglob
complete -F _limber limber
