"""Names of joints in languages other than English.

Japanese names are those of MikuMikuDance.
"""

WIDE_SIDE = {"左": "left", "右": "right"}
_JAPANESE_CENTRAL = {"下半身": "hips", "上半身": "spine", "首": "neck", "頭": "head"}
_JAPANESE_SIDED = {
    **{"肩": "shoulder", "腕": "upper_arm", "ひじ": "forearm", "肘": "forearm", "手首": "hand"},
    **{"足": "thigh", "ひざ": "shin", "膝": "shin", "足首": "foot", "つま先": "toe"},
    **{"親指": "thumb", "人指": "index", "人差指": "index", "中指": "middle", "薬指": "ring", "小指": "pinky"},
}

_CHINESE_CENTRAL = {
    **dict.fromkeys(("骨盆", "盆骨", "臀", "臀部", "髋", "髋部"), "hips"),
    **dict.fromkeys(("脊柱", "脊椎", "胸", "胸部", "腹部"), "spine"),
    **dict.fromkeys(("颈", "颈部", "脖子"), "neck"),
    **dict.fromkeys(("头", "头部"), "head"),
}
_CHINESE_SIDED = {
    **dict.fromkeys(("肩膀", "肩部", "锁骨"), "shoulder"),
    **dict.fromkeys(("上臂", "大臂"), "upper_arm"),
    **dict.fromkeys(("前臂", "小臂", "手肘", "肘部"), "forearm"),
    **dict.fromkeys(("手", "手掌", "手腕"), "hand"),
    "大腿": "thigh",
    **dict.fromkeys(("小腿", "膝盖"), "shin"),
    **dict.fromkeys(("脚", "脚踝", "脚腕"), "foot"),
    **dict.fromkeys(("脚趾", "脚尖"), "toe"),
    **{"拇指": "thumb", "食指": "index", "无名指": "ring", "小拇指": "pinky"},
}
WIDE_CENTRAL = _JAPANESE_CENTRAL | _CHINESE_CENTRAL
WIDE_SIDED = _JAPANESE_SIDED | _CHINESE_SIDED

# German, Spanish, French, Italian, Portuguese, Dutch, Polish and Japanese in Latin letters, without accents.
FOREIGN_SIDE = {
    **dict.fromkeys(("links", "linke", "linker", "linkes", "izq", "izquierda", "izquierdo", "gauche"), "left"),
    **dict.fromkeys(("sinistra", "sinistro", "sx", "esquerda", "esquerdo", "esq"), "left"),
    **dict.fromkeys(
        ("rechts", "rechte", "rechter", "rechtes", "der", "derecha", "derecho", "droite", "droit"), "right"
    ),
    **dict.fromkeys(("destra", "destro", "dx", "direita", "direito", "dir"), "right"),
    **dict.fromkeys(("lewa", "lewe", "lewy", "hidari"), "left"),
    **dict.fromkeys(("prawa", "prawe", "prawy", "migi"), "right"),
}
FOREIGN_CENTRAL = {
    **dict.fromkeys(
        ("becken", "huefte", "hufte", "cadera", "caderas", "bassin", "hanches", "bacino", "quadril"), "hips"
    ),
    **dict.fromkeys(("wirbelsaeule", "wirbelsaule", "brust", "bauch", "columna", "pecho", "colonne", "torse"), "spine"),
    **dict.fromkeys(("poitrine", "spina", "petto", "torace", "coluna", "peito"), "spine"),
    **dict.fromkeys(("heup", "heupen", "bekken", "biodra", "miednica", "koshi"), "hips"),
    **dict.fromkeys(("wervelkolom", "borst", "kregoslup", "sebone", "mune"), "spine"),
    **dict.fromkeys(("hals", "nacken", "cuello", "cou", "collo", "pescoco", "nek", "szyja", "kubi"), "neck"),
    **dict.fromkeys(("kopf", "cabeza", "tete", "testa", "cabeca", "hoofd", "glowa", "atama"), "head"),
}
FOREIGN_SIDED = {
    **dict.fromkeys(("schulter", "schluesselbein", "hombro", "clavicula", "epaule", "spalla", "ombro"), "shoulder"),
    **dict.fromkeys(("oberarm", "brazo", "bras", "braccio", "braco"), "upper_arm"),
    **dict.fromkeys(("unterarm", "ellbogen", "antebrazo", "codo", "avantbras", "coude"), "forearm"),
    **dict.fromkeys(("avambraccio", "gomito", "antebraco", "cotovelo"), "forearm"),
    **dict.fromkeys(("handgelenk", "mano", "muneca", "main", "poignet", "polso", "mao", "pulso"), "hand"),
    **dict.fromkeys(("oberschenkel", "muslo", "cuisse", "coscia", "coxa"), "thigh"),
    **dict.fromkeys(("unterschenkel", "knie", "pierna", "pantorrilla", "rodilla", "jambe", "genou"), "shin"),
    **dict.fromkeys(("gamba", "ginocchio", "perna", "joelho"), "shin"),
    **dict.fromkeys(("knoechel", "knochel", "tobillo", "cheville", "caviglia", "tornozelo"), "ankle"),
    **dict.fromkeys(("fuss", "pie", "pied", "piede", "pe"), "foot"),
    **dict.fromkeys(("zehe", "zehen", "dedos", "orteil", "orteils", "dita"), "toe"),
    **dict.fromkeys(("schouder", "sleutelbeen", "bark", "kata"), "shoulder"),
    **dict.fromkeys(("bovenarm", "ramie", "ude"), "upper_arm"),
    **dict.fromkeys(("onderarm", "elleboog", "przedramie", "lokiec", "hiji"), "forearm"),
    **dict.fromkeys(("pols", "dlon", "nadgarstek", "tekubi"), "hand"),
    **dict.fromkeys(("dij", "dijbeen", "bovenbeen", "udo", "momo"), "thigh"),
    **dict.fromkeys(("onderbeen", "scheenbeen", "podudzie", "lydka", "kolano", "hiza", "sune"), "shin"),
    **dict.fromkeys(("enkel", "kostka", "ashikubi"), "ankle"),
    **dict.fromkeys(("voet", "stopa"), "foot"),
    **dict.fromkeys(("teen", "tenen", "palce", "tsumasaki"), "toe"),
}
