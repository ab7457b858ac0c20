"""Settings with which a program is fastest, found by short runs turn by turn."""
import statistics


def fastest(rate, scene, settings, tries):
    if len(settings) == 1:
        return settings[0]
    rates = [[] for _ in settings]
    for _ in range(tries):
        for setting, found in zip(settings, rates):
            found.append(rate(scene, setting))
    medians = [statistics.median(found) for found in rates]
    return settings[medians.index(max(medians))]


def best_setting(rate, scene, styles, skins, tries):
    """First the style, at the first skin, then the skin. @param rate  of a scene and a setting, a dict"""
    skins = [skin for skin in skins if skin >= scene.least_skin] or [scene.least_skin]
    style = fastest(rate, scene, [style | {"skin": skins[0]} for style in styles], tries)
    return fastest(rate, scene, [style | {"skin": skin} for skin in skins], tries)
