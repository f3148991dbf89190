import sys
from dataclasses import replace
import benchmarks.validation.gait_realism as g
from benchmarks.validation._gait_rows import judged,inside
from benchmarks.validation._gait_page import bounds
def main():
    import json
    base=json.load(open('scratch/g_main.json'))['verdicts']
    real=g.read_real(g.BESIDE,50.0); rows=[]
    for seed in (1,2,3,4,5,6):
        g.FEET={k:(replace(c,seed=seed),m) for k,(c,m) in g.FEET.items()}; g.WALKS={k:replace(c,seed=seed) for k,c in g.WALKS.items() if k in ('1.0','1.3','1.5','shorter','taller')}
        sim,_=g.simulate(110.0,50.0,None,2); a,b=g.all_figures(real,sim); t=g.tally(a,b); n=sum(v=='inside' for v in t.values()); rows.append(n)
        print('seed',seed,n)
        for row in judged():
            if t[row.key]!='inside': print('    %-20s %-8s was %-8s %5.2f..%5.2f  '%(row.key,t[row.key],base[row.key],*bounds(row,a)),' '.join('%s:%.2f'%(k,f[row.key]) for k,f in b.items()))
    print('ROWS',rows)
if __name__=='__main__': main()
