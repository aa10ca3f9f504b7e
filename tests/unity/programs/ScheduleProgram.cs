// Prints what the schedule of decodes and the budget of a frame decide, for tests/unity/test_schedule.py. Arguments: turns or
// budget, and a file of lines as tests/fixtures/turn_scenarios.py writes them.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Mua;

internal static class ScheduleProgram
{
    private static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        var budget = new FrameBudget();
        var schedule = new DecodeSchedule();
        var turns = new Dictionary<int, DecodeTurn>();
        foreach (string line in File.ReadAllLines(arguments[1]))
        {
            double[] numbers = Array.ConvertAll(line.Split(' '), double.Parse);
            Console.WriteLine(arguments[0] == "budget" ? Budgeted(budget, numbers) : Planned(schedule, turns, numbers));
        }
    }

    private static string Budgeted(FrameBudget budget, double[] numbers)
    {
        budget.Measure(numbers[0], numbers[1], numbers[2] > 0, (int)numbers[3], (int)numbers[4], (int)numbers[5]);
        return budget.Parts + " " + budget.Splats;
    }

    private static string Planned(DecodeSchedule schedule, Dictionary<int, DecodeTurn> turns, double[] numbers)
    {
        int at = 3, gone = (int)numbers[2];
        for (int i = 0; i < gone; i++)
        {
            turns.Remove((int)numbers[at++]);
        }
        var keys = new List<int>();
        var asked = new List<DecodeTurn>();
        for (int left = (int)numbers[at++]; left > 0; left--, at += 7)
        {
            int key = (int)numbers[at];
            if (!turns.ContainsKey(key))
            {
                turns[key] = new DecodeTurn();
            }
            keys.Add(key);
            asked.Add(turns[key]);
            turns[key].Ask = new DecodeAsk
            {
                Due = (long)numbers[at + 1],
                Following = (long)numbers[at + 2],
                Level = (int)numbers[at + 3],
                Rank = numbers[at + 4],
                Spreads = numbers[at + 5] > 0,
                MayLag = numbers[at + 6] > 0,
            };
        }
        schedule.Plan(asked, (int)numbers[0], (int)numbers[1], asked.Count == 1);
        var printed = new List<string>();
        for (int i = 0; i < keys.Count; i++)
        {
            DecodeSteps steps = asked[i].Steps;
            printed.Add(
                keys[i] + ":" + Named(steps.Whole) + "," + steps.Finish + "," + (steps.Shows ? 1 : 0) + ","
                + Named(steps.Begin) + "," + steps.Parts);
        }
        return string.Join(" ", printed.ToArray());
    }

    private static string Named(long decode)
    {
        return decode == DecodeTurn.None ? "-" : DecodeTurn.Window(decode) + "@" + DecodeTurn.Level(decode);
    }
}
