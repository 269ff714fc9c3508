# Completion of rhegma's command line for bash.
_rhegma() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
    local options="--set -o --quiet --help"
    case $before in
    --set)
        COMPREPLY=($(compgen -S = -W "$(rhegma keys 2>/dev/null | grep '^[a-z][^[]*$')" -- "$word"))
        compopt -o nospace 2>/dev/null
        return
        ;;
    --isa) COMPREPLY=($(compgen -W "x86-64-v2 x86-64-v3 x86-64-v4 generic" -- "$word")) && return ;;
    -o | --restart)
        COMPREPLY=($(compgen $([[ $command =~ ^(export|mesh|material)$ ]] && echo -f || echo -d) -- "$word"))
        return
        ;;
    --unit) COMPREPLY=($(compgen -W "m cm mm um nm in ft" -- "$word")) && return ;;
    --walltime | --time | --scale | --merge | --crack | --extrude | --size | --curvature) return ;;
    esac
    case $command in
    run) options+=" --restart --overwrite --walltime" ;;
    mesh) options="-o --unit --scale --merge --apart --crack --extrude --split --size --curvature --improve --tile --set --info --case --partition --help" ;;
    keys) options="--markdown --schema --help" ;;
    export) options="-o --time --crack --help" ;;
    material) options="-o --law --isa --help" ;;
    verify | materials) options="--help" ;;
    esac
    if [ "$COMP_CWORD" = 1 ]; then
        COMPREPLY=($(compgen -W "run check export keys material materials verify mesh --version --help" -- "$word"))
    elif [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
    elif [ "$command" = materials ]; then
        COMPREPLY=($(compgen -W "$(rhegma materials 2>/dev/null | cut -d" " -f1)" -- "$word"))
    elif [ "$command" = keys ]; then
        COMPREPLY=($(compgen -W "$(rhegma keys 2>/dev/null | grep '^[a-z]')" -- "$word"))
    else
        COMPREPLY=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -F _rhegma rhegma
