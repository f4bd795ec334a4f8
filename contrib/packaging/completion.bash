# Completion of bash for limber: commands, options, scenes, entries of --set, fields.

_limber_entries() {
  # 'Section/Name=' of all entries, from the program itself: those of the scene or
  # study that the line names, if it is there
  local word words=()
  [[ $command != @(study|stability) ]] || words=("$command")
  words+=(--print-parameters prm)
  for word in "${COMP_WORDS[@]}"; do
    if [[ $word == *.@(prm|json) && -f $word ]]; then
      words+=("$word")
      break
    fi
  done
  limber "${words[@]}" 2>/dev/null | awk '
    $1 == "subsection" { sub(/^ *subsection +/, ""); path = path $0 "/"; next }
    $1 == "end" { sub(/[^\/]*\/$/, "", path); next }
    $1 == "set" { sub(/^ *set +/, ""); sub(/ *=.*/, ""); print path $0 "=" }'
}

_limber_offer() {
  # Lines that begin with the word. 'compgen -W' would take quotes out of them; what
  # stands in a quotation already must not be escaped.
  local line word=$1
  [[ $typed == [\"\']* ]] || word=${word//\\/}
  while read -r line; do
    [[ $line == "$word"* ]] || continue
    case $typed in
      \"*) ;;
      \'*) line=${line//\'/\'\\\'\'} ;;
      *) printf -v line %q "$line" ;;
    esac
    COMPREPLY+=("$line")
  done
}

_limber() {
  local word=$2 before=$3 typed=${COMP_WORDS[COMP_CWORD]} command=run
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
      _limber_offer "$word" < <(_limber_entries)
      compopt -o nospace
      return ;;
    --field)
      _limber_offer "$word" < <(printf '%s\n' pressure speed velocity stress \
        displacement "equivalent stress" "volume ratio" mass body)
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
    plot) options="--help --field --body --others --side-by-side --enlarge --range
      --view --grid --labels --output --time --snapshots --columns" ;;
    animate) options="--help --field --body --others --side-by-side --enlarge --range
      --view --grid --labels --output --rate --frames" ;;
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
